"""The warning of a jump: what lies ahead, the alarm, and the services that command it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.lifecycle import LifecycleNode
from std_srvs.srv import SetBool, Trigger

from sfd_hbm_ros.node.curves import LATCHED, Curves
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.jump_status import jump_status
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.prediction import Prediction
from sfd_hbm_ros.response.tracking.tracked import BranchName, Tracked
from sfd_hbm_ros.response.warning.jump_alarm import Answer, JumpAlarm
from sfd_hbm_ros.response.warning.jump_log import JumpLog
from sfd_hbm_ros.response.warning.limits import MEASURED, Approach
from sfd_hbm_ros.response.warning.outlook import Outlook, unknown_outlook
from sfd_hbm_ros.response.warning.rounding import Rounding
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

_LOOK = 0.1  # s between two looks at the alarm while nothing is predicted
_REPEAT = 1.0  # s after which the warning is published without a change


class Watch:
    """Watches for jumps, in every state of the node.

    Parameters
    ----------
    node : LifecycleNode
        The node.
    operation : Operation
        Who follows the machine.
    curves : Curves
        Who knows where it would jump.
    hardware : callable
        Returns the name of the machine.

    Attributes
    ----------
    alarm : JumpAlarm
        The alarm; its times are those of `time.monotonic`.
    jumps : JumpLog
        The jumps that the machine made.
    after_change : list of callable
        Called when the alarm has got into another state, or the machine has jumped.
    """

    def __init__(
        self,
        node: LifecycleNode,
        operation: Operation,
        curves: Curves,
        hardware: Callable[[], str],
    ) -> None:
        self.alarm = JumpAlarm(AlarmSettings())
        self.jumps = JumpLog()
        self._ahead: Outlook | None = None  # of the last prediction
        self.after_change: list[Callable[[], None]] = []
        self._node = node
        self._operation = operation
        self._curves = curves
        self._hardware = hardware
        self._rounding = Rounding()
        self._approach = Approach()
        self._published: tuple[object, ...] = ()
        self._published_at = -math.inf
        # With its namespace, so that several machines on one graph are told apart.
        self._name = node.get_fully_qualified_name().lstrip("/")
        # A plain one: a lifecycle publisher is silent while the node is inactive.
        self._publisher = node.create_publisher(DiagnosticArray, "~/jump_warning", LATCHED)
        node.create_service(Trigger, "~/acknowledge", self._acknowledge)
        node.create_service(Trigger, "~/reset", self._reset)
        node.create_service(SetBool, "~/shelve", self._shelve)
        node.create_timer(_LOOK, self.look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        operation.after_prediction.append(self._follow)
        operation.after_forgetting.append(lambda: self.jumps.lose_sight())

    @property
    def signature(self) -> tuple[object, ...]:
        """What of the alarm is worth telling at once when it changes."""
        now = time.monotonic()
        alarms = (
            (one.active, one.raised, one.acknowledged, one.occurrences)
            for one in self.alarm.alarms.values()
        )
        jumps = self.jumps.count, self.jumps.unseen
        return self.alarm.level(now), self.alarm.state(now), *alarms, *jumps

    def release(self) -> None:
        """Forget the alarm together with the machine."""
        self.alarm = JumpAlarm(self.alarm.settings)
        self.jumps = JumpLog()
        self._approach = Approach()

    def look(self) -> None:
        """Have the alarm take what lies ahead, and publish what has changed."""
        now = time.monotonic()
        tracked = self._tracked()
        outlook = self._ahead = self._outlook(tracked)
        reported = self.alarm.alarms[Level.ERROR].present
        settings = self._approach.fitted(
            self.alarm.settings, outlook.time_to_jump, reported=reported
        )
        eccentricity = _greatest(outlook, _eccentricity(tracked))
        seen, outside = self._operation.seen, bool(self._curves.outside)
        measured = {MEASURED.name: seen.eccentricity}
        self.alarm.update(outlook, eccentricity, now, measured, settings, doubtful=seen.differs)
        shown = self._branch(tracked), self._curves.usable, outside, seen.differs
        signature = *self.signature, *shown
        if signature != self._published:
            for call in self.after_change:
                call()
        elif now - self._published_at < _REPEAT:
            return
        self._published, self._published_at = signature, now
        stamp = self._node.get_clock().now()
        status = [self.status()]
        self._publisher.publish(
            messages.diagnostics_message(stamp, self._name, self._hardware(), status)
        )

    def status(self) -> Status:
        """Return the warning."""
        tracked = self._tracked()
        outlook, branch, age = (
            self._outlook(tracked),
            self._branch(tracked),
            self._curves.outdated_for,
        )
        given = _eccentricity(tracked), age, time.monotonic(), self._rounding, self._operation.seen
        status = jump_status(self.alarm, outlook, branch, *given)
        level = status.level
        # Where no jump is seen, that all is well is not either.
        if self._curves.outside and not self.alarm.shelved_for(time.monotonic()):
            level = max(level, Level.WARN)
        stamp = self._node.get_clock().now().nanoseconds * 1e-9
        message = self.jumps.sentence(stamp) + status.message + self._reservation(age)
        jumps = {"jumps": str(self.jumps.count), "last_jumps": "; ".join(self.jumps.rows)}
        values = {**status.values, **self._curves.revisions, **jumps}
        return replace(status, level=level, message=message, values=values)

    def _follow(self, prediction: Prediction, stamp: int) -> None:
        """Notice whether the machine has jumped, and look at what lies ahead now."""
        if prediction.tracked:
            self.jumps.take(prediction.tracked, stamp * 1e-9, self._ahead)
        self.look()

    def _reservation(self, age: float) -> str:
        """Return why the warning is none, or under which reservation it stands."""
        silence = self._operation.silence
        if silence:
            return f"; nothing is predicted, as {silence}"
        if self._tracked() is None:
            return "; there is no prediction, as the status Solver tells"
        if math.isnan(age):
            return "; there is no response curve yet"
        if self._curves.outside:
            return f"; the speed is {self._curves.outside}"
        use = "still used" if self._curves.usable else "of no use any more"
        since = self._rounding.within_time("age", age)
        return f"; the response curve has been outdated for {since} and is {use}" if age else ""

    def _tracked(self) -> Tracked | None:
        """The operating point; None while it is not known."""
        prediction = self._operation.believed
        return None if self._operation.silence or prediction is None else prediction.tracked

    def _branch(self, tracked: Tracked | None) -> BranchName:
        return tracked.branch if tracked else BranchName.UNKNOWN

    def _outlook(self, tracked: Tracked | None) -> Outlook:
        """What lies ahead; unknown where no curve tells.

        Where the branch is not known, that of every response on which the machine may be.
        """
        course = self._operation.acceleration, self._operation.settled
        jumps, speed = self._curves.jumps, tracked.solution.speed if tracked else math.nan
        if jumps is None or tracked is None or tracked.place is None:
            return unknown_outlook(speed, course[0])
        if tracked.branch is BranchName.UNKNOWN:
            return jumps.outlook_of_any(speed, *course)
        return jumps.outlook(tracked.place, *course)

    def _acknowledge(self, _: Any, response: Trigger.Response) -> Trigger.Response:
        answer = self.alarm.acknowledge()
        if self.jumps.acknowledge():
            answer = Answer(True, "acknowledged")
        return self._answered(response, answer)

    def _reset(self, _: Any, response: Trigger.Response) -> Trigger.Response:
        return self._answered(response, self.alarm.reset())

    def _shelve(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        alarm = self.alarm
        answer = alarm.shelve(time.monotonic()) if request.data else alarm.unshelve()
        return self._answered(response, answer)

    def _answered(self, response: Any, answer: Answer) -> Any:
        """Tell at once what a command has changed, and answer it."""
        self.look()
        response.success, response.message = answer
        self._node.get_logger().info(f"alarm: {answer.sentence}")
        return response


def _eccentricity(tracked: Tracked | None) -> float:
    """Greatest eccentricity of any damper; NaN where it is not known."""
    return tracked.solution.eccentricity_max if tracked else math.nan


def _greatest(outlook: Outlook, eccentricity: float) -> float:
    """Greatest eccentricity that the machine may have, where its response is not known."""
    possible = (outlook, *outlook.others) if outlook.others else ()
    return max([eccentricity, *(one.eccentricity for one in possible)])
