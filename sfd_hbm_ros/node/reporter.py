"""The node's signs of life: its heartbeat and its diagnostics, in every state."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.qos import LivelinessPolicy, QoSProfile
from std_msgs.msg import Header

from sfd_hbm_ros.hbm.time_limit import tell_progress
from sfd_hbm_ros.node.diagnostics import Levels, Status
from sfd_hbm_ros.node.messages import common as messages

_QUEUE = 10
_REPORT = 1.0  # s between two reports, REP 107
_BEAT = 0.1  # s between two heartbeats
# A step of the work may take so much processor time [s], however long that is on a busy computer,
# and may wait so long for something else [s]. Then the work counts as stuck.
_BUSY, _WAITS = 3.0, 3.0
_SHARE = 0.02  # of a processor; who gets less waits for something else
# Manual: what counts as a sign of life is a heartbeat, not that the process exists.
_HEARTBEAT_QOS = QoSProfile(
    depth=1,
    deadline=Duration(seconds=5 * _BEAT),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(seconds=10 * _BEAT),
)


class Heart:
    """Beats while the thread that made it gets on with its work, however much that is.

    A thread of its own beats, as a subscriber takes a node for dead after half a second, and a
    single prediction or request may take longer on a busy computer. A thread that is stuck, in a
    loop or waiting, takes no further step, and the heart stops.

    Parameters
    ----------
    beat : callable
        Called ten times a second.
    """

    def __init__(self, beat: Callable[[], None]) -> None:
        self._beat = beat
        self._steps = 0
        self._clock = time.pthread_getcpuclockid(threading.get_ident())
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._go_on, daemon=True)
        self._thread.start()

    def step(self) -> None:
        """Note that the work has got on."""
        self._steps += 1

    def stop(self) -> None:
        """Beat no more."""
        self._stopped.set()
        self._thread.join()

    def _go_on(self) -> None:
        seen, before, begun = -1, 0.0, 0.0
        due = time.monotonic()
        while True:
            due = max(due + _BEAT, time.monotonic())
            if self._stopped.wait(max(0.0, due - time.monotonic())):
                return
            try:
                used, now = time.clock_gettime(self._clock), time.monotonic()
            except OSError:
                return  # the thread is gone
            if self._steps != seen:
                seen, before, begun = self._steps, used, now
            processor, wall = used - before, now - begun
            if processor < _BUSY and (wall < _WAITS or processor > _SHARE * wall):
                self._beat()


class Reporter:
    """Publishes the heartbeat and the diagnostics of a node.

    The timers follow a steady clock, as the node's may stand still or jump.

    Parameters
    ----------
    node : Node
        The node.
    hardware : callable
        Returns the name of what is diagnosed.
    statuses : callable
        Returns how each subject fares now.

    Attributes
    ----------
    step : callable
        To be called as the node gets on with long work, see `Heart`.
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
        node.create_timer(_BEAT, self._look, clock=steady)
        node.create_timer(_REPORT, self._report, clock=steady)
        self._heart = Heart(self._beat)
        self.step = self._heart.step
        tell_progress(self.step)

    def close(self) -> None:
        """Let the heart stand still."""
        self._heart.stop()

    def report_worsening(self) -> None:
        """Publish the diagnostics now if a subject fares worse than was published."""
        statuses = self._statuses()
        if self._levels.worsened(statuses):
            self._publish(statuses)

    def _report(self) -> None:
        self._publish(self._statuses())

    def _look(self) -> None:
        self.step()
        self.report_worsening()

    def _beat(self) -> None:
        """Publish a heartbeat; another thread does."""
        with suppress(InvalidHandle, RuntimeError):  # the node is being destroyed
            now = self._node.get_clock().now()
            self._heartbeat.publish(messages.heartbeat_message(now, self._name))

    def _publish(self, statuses: list[Status]) -> None:
        self._levels.publish(statuses)
        now, hardware = self._node.get_clock().now(), self._hardware()
        message = messages.diagnostics_message(now, self._name, hardware, statuses)
        self._diagnostics.publish(message)
