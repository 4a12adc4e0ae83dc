"""Questions about other speeds, answered beside the predictions."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any, NamedTuple

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.lifecycle import LifecycleNode
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.node.curves import Curves
from sfd_hbm_ros.node.dropping import dropping
from sfd_hbm_ros.node.inputs import Drops, InputError, Order
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.messages.what_if import (
    MOST,
    Answer,
    read_what_if,
    refusals,
    what_if_message,
)
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.slices import PERIOD, advance
from sfd_hbm_ros.response.tracking.what_if import what_if

MOST_WAITING = 10
"""Questions that may wait; further ones are refused."""

_QUEUE = 10  # reliable


class _Question(NamedTuple):
    stamp: Any  # builtin_interfaces/Time
    speeds: list[float]


class WhatIf:
    """Answers what the machine would do if it went from its present state to another speed.

    Questions are answered in their order, a slice of work at a time. They wait until the response
    curve is that of the machine as it is: who has just changed a parameter hears of the machine
    with the new one. All speeds of a question are answered for one state of the machine. What is
    refused or cannot be answered is answered all the same, with NaN and the reason.

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
        self._asked: _Question | None = None  # what is being answered
        self._work: Iterator[None] = iter(())
        # A plain one: a lifecycle publisher is silent while the node is inactive.
        self._publisher = node.create_publisher(JointState, "~/what_if/result", _QUEUE)
        topic = node.create_subscription(JointState, "~/what_if/request", self._take, _QUEUE)
        self.drops = Drops(topic.topic_name)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self._go_on, clock=steady, autostart=False)

    def _take(self, message: JointState) -> None:
        """Have a question wait, or refuse it."""
        with dropping(self._node, self.drops):
            try:
                self._queue(message)
            except (InputError, MachineError) as error:
                asked = _Question(message.header.stamp, list(message.velocity[:MOST]))
                self._refuse(asked, str(error))
                raise

    def _queue(self, message: JointState) -> None:
        """Have a question wait.

        Raises
        ------
        InputError
            If it is refused.
        """
        speeds = read_what_if(message)
        stamp = messages.read_stamp(message.header)
        if not self._operation.active:
            raise InputError("the node is not active")
        if len(self._waiting) >= MOST_WAITING:
            raise InputError(f"{MOST_WAITING} questions are waiting already")
        # Who asks are several, so that stamps have no order.
        stamp = Order().check(stamp, self._node.get_clock().now().nanoseconds)
        self._waiting.append(_Question(Time(nanoseconds=stamp).to_msg(), speeds))
        self._timer.reset()

    def _go_on(self) -> None:
        """Do a slice of the work."""
        if not self._operation.active:
            self._give_up("the node has been deactivated")
        elif self._curves.worker.failed and not self._curves.holds:
            self._give_up(f"there is no response curve: {self._curves.worker.problem}")
        if advance(self._work):
            return
        self._asked = None
        if not self._waiting:
            self._timer.cancel()
        elif self._curves.holds:
            self._asked = self._waiting.popleft()
            self._work = self._answered(self._asked)

    def _give_up(self, reason: str) -> None:
        """Answer all questions that there is no answer."""
        for question in (*([self._asked] if self._asked else []), *self._waiting):
            self._refuse(question, reason)
        self._waiting.clear()
        self._asked, self._work = None, iter(())

    def _refuse(self, question: _Question, reason: str) -> None:
        """Answer that there is no answer, and why."""
        model = self._operation.model
        answers = refusals(question.speeds, model.unknown() if model else {}, reason)
        self._publish(question, answers)

    def _publish(self, question: _Question, answers: list[Answer]) -> None:
        message = what_if_message(Time(), self._parameters["frame_id"], answers)
        message.header.stamp = question.stamp  # as it was sent, even if it is none
        self._publisher.publish(message)

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
            reason = "" if found.solution.converged else found.solution.message
            answers.append(Answer(speed, found.solution.journals, others, reason))
        self._publish(question, answers)
