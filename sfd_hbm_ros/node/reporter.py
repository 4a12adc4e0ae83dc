"""The node's signs of life: its heartbeat and its diagnostics, in every state."""

from __future__ import annotations

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import LivelinessPolicy, QoSProfile
from std_msgs.msg import Header

from sfd_hbm_ros.node.diagnostics import Levels, Status
from sfd_hbm_ros.node.messages import common as messages

_QUEUE = 10
_REPORT = 1.0  # s between two reports, REP 107
_BEAT = 0.1  # s between two heartbeats
# Manual: what counts as a sign of life is a heartbeat, not that the process exists.
_HEARTBEAT_QOS = QoSProfile(
    depth=1,
    deadline=Duration(seconds=5 * _BEAT),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(seconds=10 * _BEAT),
)


class Reporter:
    """Publishes the heartbeat and the diagnostics of a node.

    The timers follow a steady clock, as the node's may stand still or jump. They are served by
    the thread that predicts: while that is stuck, there is no heartbeat.

    Parameters
    ----------
    node : Node
        The node.
    hardware : callable
        Returns the name of what is diagnosed.
    statuses : callable
        Returns how each subject fares now.
    """

    def __init__(
        self, node: Node, hardware: Callable[[], str], statuses: Callable[[], list[Status]]
    ) -> None:
        self._node = node
        self._hardware = hardware
        self._statuses = statuses
        self._levels = Levels()
        # With its namespace, so that several machines on one graph are told apart.
        self._name = node.get_fully_qualified_name().lstrip("/")
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", _QUEUE)
        self._heartbeat = node.create_publisher(Header, "~/heartbeat", _HEARTBEAT_QOS)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        node.create_timer(_BEAT, self._beat, clock=steady)
        node.create_timer(_REPORT, self._report, clock=steady)

    def report_worsening(self) -> None:
        """Publish the diagnostics now if a subject fares worse than was published."""
        statuses = self._statuses()
        if self._levels.worsened(statuses):
            self._publish(statuses)

    def _report(self) -> None:
        self._publish(self._statuses())

    def _beat(self) -> None:
        now = self._node.get_clock().now()
        self._heartbeat.publish(messages.heartbeat_message(now, self._name))
        self.report_worsening()

    def _publish(self, statuses: list[Status]) -> None:
        self._levels.publish(statuses)
        now, hardware = self._node.get_clock().now(), self._hardware()
        message = messages.diagnostics_message(now, self._name, hardware, statuses)
        self._diagnostics.publish(message)
