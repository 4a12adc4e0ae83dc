"""Questions about other speeds, answered beside the predictions."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.lifecycle import LifecycleNode
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.node.curves import Curves
from sfd_hbm_ros.node.dropping import dropping
from sfd_hbm_ros.node.inputs import Drops, InputError, Order
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.messages.what_if import Answer, read_what_if, what_if_message
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.slices import PERIOD, advance
from sfd_hbm_ros.response.tracking.what_if import what_if

MOST_WAITING = 10
"""Questions that may wait; further ones are refused."""

_QUEUE = 10  # reliable


class _Question(NamedTuple):
    stamp: int
    speeds: list[float]


class WhatIf:
    """Answers what the machine would do if it went from its present state to another speed.

    Questions are answered in their order, a slice of work at a time. They wait until the response
    curve is that of the machine as it is: who has just changed a parameter hears of the machine
    with the new one. All speeds of a question are answered for one state of the machine.

    Parameters
    ----------
    node : LifecycleNode
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Who follows the machine.
    curves : Curves
        Who knows its response curve.

    Attributes
    ----------
    drops : Drops
        Questions that were refused.
    """

    def __init__(
        self, node: LifecycleNode, parameters: Parameters, operation: Operation, curves: Curves
    ) -> None:
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._curves = curves
        self._waiting: deque[_Question] = deque()
        self._work: Iterator[None] = iter(())
        self._publisher = node.create_lifecycle_publisher(JointState, "~/what_if/result", _QUEUE)
        topic = node.create_subscription(JointState, "~/what_if/request", self._take, _QUEUE)
        self.drops = Drops(topic.topic_name)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self._go_on, clock=steady, autostart=False)

    def _take(self, message: JointState) -> None:
        """Have a question wait, or refuse it."""
        with dropping(self._node, self.drops):
            speeds = read_what_if(message)
            stamp = messages.read_stamp(message.header)
            if not self._operation.active:
                raise InputError("the node is not active")
            if len(self._waiting) >= MOST_WAITING:
                raise InputError(f"{MOST_WAITING} questions are waiting already")
            # Who asks are several, so that stamps have no order.
            stamp = Order().check(stamp, self._node.get_clock().now().nanoseconds)
            self._waiting.append(_Question(stamp, speeds))
            self._timer.reset()

    def _go_on(self) -> None:
        """Do a slice of the work."""
        if not self._operation.active:
            self._waiting.clear()
            self._work = iter(())
        if advance(self._work):
            return
        if not self._waiting:
            self._timer.cancel()
        elif self._curves.usable:
            self._work = self._answered(self._waiting.popleft())

    def _answered(self, question: _Question) -> Iterator[None]:
        """Answer a question, speed by speed."""
        model = self._operation.model
        assert model is not None  # as there is a curve of it
        model.balance()
        guide, place = model.tracker.guide, model.tracker.place
        answers = []
        for speed in question.speeds:
            yield
            found = what_if(guide, place, speed)
            others = found.other.journals if found.other else {}
            answers.append(Answer(speed, found.solution.journals, others))
        header = Time(nanoseconds=question.stamp), self._parameters["frame_id"]
        self._publisher.publish(what_if_message(*header, answers))
