"""The orbits of the journals, for who wants to see them."""

from __future__ import annotations

import time

from geometry_msgs.msg import PolygonStamped
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.lifecycle import LifecycleNode
from rclpy.time import Time

from sfd_hbm_ros.node.inputs import Pending
from sfd_hbm_ros.node.messages.curve import orbit_message
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.prediction import Prediction

_QUEUE = 10
_POINTS = 128  # of one orbit
_RATE = 5.0  # Hz, as fast as somebody can look


class Orbits:
    """Publishes the newest orbits, five times a second while somebody subscribes.

    A journal's orbit is in the frame that bears its damper's name.

    Parameters
    ----------
    node : LifecycleNode
        The node.
    operation : Operation
        Who predicts.
    """

    def __init__(self, node: LifecycleNode, operation: Operation) -> None:
        self._pending: Pending[tuple[Prediction, int]] = Pending(_RATE)
        self._publisher = node.create_lifecycle_publisher(PolygonStamped, "~/orbit", _QUEUE)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._due = node.create_timer(1.0, self._publish, clock=steady, autostart=False)
        operation.after_prediction.append(self._take)

    def _take(self, prediction: Prediction, stamp: int) -> None:
        """Publish now, or as soon as the rate allows it."""
        if prediction.tracked is None or not self._publisher.get_subscription_count():
            return
        waits = self._pending.waits
        self._pending.put((prediction, stamp))
        wait = self._pending.wait(time.monotonic())
        if wait <= 0.0:
            self._publish()
        elif not waits:
            self._due.timer_period_ns = int(wait * 1e9)
            self._due.reset()

    def _publish(self) -> None:
        self._due.cancel()
        taken = self._pending.take(time.monotonic())
        if taken is None:
            return
        prediction, stamp = taken
        for damper, motion in prediction.journals.items():
            message = orbit_message(Time(nanoseconds=stamp), damper, motion, _POINTS)
            self._publisher.publish(message)
