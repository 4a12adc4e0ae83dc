"""The oil's temperature, which sets the viscosity in all dampers."""

from __future__ import annotations

import time
from collections.abc import Sequence

from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Temperature

from sfd_hbm_ros.machine import Damper
from sfd_hbm_ros.node.dropping import dropping
from sfd_hbm_ros.node.inputs import Feed, InputError
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters

DEADBAND = 0.01
"""Part by which the viscosity has to differ from a damper's before the machine is changed."""

_QUEUE = 10


class OilFeed:
    """Sets the parameters dampers.*.viscosity as the oil warms up.

    It sets them as anybody else may, so that they tell the truth; who sets one by hand while
    temperatures arrive is overruled by the next.

    Parameters
    ----------
    node : Node
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Who has the machine.

    Attributes
    ----------
    feed : Feed
        The temperatures that arrived [deg C].
    """

    def __init__(self, node: Node, parameters: Parameters, operation: Operation) -> None:
        self._node = node
        self._parameters = parameters
        self._operation = operation
        topic = node.create_subscription(Temperature, "~/oil_temperature", self._take, _QUEUE)
        self.feed: Feed[float] = Feed(topic.topic_name)

    def _take(self, message: Temperature) -> None:
        with dropping(self._node, self.feed):
            celsius = messages.read_temperature(message)
            stamp = messages.read_stamp(message.header)
            model, oil = self._operation.model, self._parameters.oil()
            if model is None:
                raise InputError("there is no machine yet: the node is not configured")
            if oil is None:
                raise InputError("no oil is configured: set oil.grade, or its viscosities")
            viscosity = oil.viscosity(celsius)
            clock = int(self._node.get_clock().now().nanoseconds)
            self.feed.accept(celsius, stamp, clock, time.monotonic())
            self._set(model.machine.dampers, viscosity)

    def _set(self, dampers: Sequence[Damper], viscosity: float) -> None:
        """Set the viscosity of all dampers [Pa s] if that of any differs."""
        if all(abs(viscosity / one.viscosity - 1.0) < DEADBAND for one in dampers):
            return
        names = [f"{damper.where}.viscosity" for damper in dampers]
        values = [Parameter(name, value=viscosity) for name in names]
        result = self._node.set_parameters_atomically(values)
        if not result.successful:
            raise InputError(result.reason)
