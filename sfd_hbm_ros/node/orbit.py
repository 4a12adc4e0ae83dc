"""The orbits of the journals, for who wants to see them."""

from __future__ import annotations

from geometry_msgs.msg import PolygonStamped
from rclpy.lifecycle import LifecycleNode
from rclpy.time import Time

from sfd_hbm_ros.node.messages.curve import orbit_message
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.prediction import Prediction

_QUEUE = 10
_POINTS = 128  # of one orbit


class Orbits:
    """Publishes every orbit of a prediction while somebody subscribes.

    A journal's orbit is in the frame that bears its damper's name.

    Parameters
    ----------
    node : LifecycleNode
        The node.
    operation : Operation
        Who predicts.
    """

    def __init__(self, node: LifecycleNode, operation: Operation) -> None:
        self._publisher = node.create_lifecycle_publisher(PolygonStamped, "~/orbit", _QUEUE)
        operation.after_prediction.append(self._publish)

    def _publish(self, prediction: Prediction, stamp: int) -> None:
        if prediction.tracked is None or not self._publisher.get_subscription_count():
            return
        for damper, motion in prediction.journals.items():
            message = orbit_message(Time(nanoseconds=stamp), damper, motion, _POINTS)
            self._publisher.publish(message)
