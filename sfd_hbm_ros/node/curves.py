"""The response curve of the machine: asked for when it changes, adopted and published."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState, PointCloud2
from std_srvs.srv import Trigger

from sfd_hbm_ros.hbm import Solution
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.lean_node import LeanNode
from sfd_hbm_ros.node.messages.curve import curve_arrays_message, response_curve_message
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.speed_range import SpeedRange, outside
from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult
from sfd_hbm_ros.node.worker.renewal import MeanLoads, Renewal
from sfd_hbm_ros.node.worker.worker import Patience, Worker
from sfd_hbm_ros.response.curves.deviation import HOLDS, deviation, landmarks
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.warning.jump_map import JumpMap, jump_map
from sfd_hbm_ros.response.warning.settings import Level
from sfd_hbm_ros.units import RPM

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Reliable, and the last message is there for whoever comes later."""

_POLL = 0.1  # s between two looks at the worker process
_JUDGE = 0.5  # s between two comparisons of the curve with the machine as loads change it
_HELD = 1.5  # s for which the curve holds on after responses that it does not hold for
_QUIET = 2.0  # s without another load, after which the curve is made exactly that of the machine


class Curves:
    """Keeps the response curve of the machine as new as it can be.

    A worker process computes it, soon after each change of the machine, its loads, the harmonics
    or the range. Until a new curve is whole the operation goes on with the old one.

    Loads that arrive tremble. A curve holds for them as long as its responses do, and is computed
    anew where they have not for a while, for the mean of the loads meanwhile.

    Parameters
    ----------
    node : LeanNode
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Whose machine it is, and who follows it along the curve.

    Attributes
    ----------
    worker : Worker
        The worker process.
    result : CurveResult or None
        The newest curve.
    holds : bool
        Whether its responses are those of the machine as it is at this moment, or nearly so.
    revision : int
        Which of the states of the machine it is that curves were asked for, counted from 1.
    """

    def __init__(self, node: LeanNode, parameters: Parameters, operation: Operation) -> None:
        self.worker = Worker()
        self.result: CurveResult | None = None
        self.holds = False
        self.revision = 0
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._jumps: JumpMap | None = None
        self._landmarks: tuple[Solution, ...] = ()
        self._own: tuple[object, ...] | None = None  # all but the loads that arrived
        self._present: CurveJob | None = None  # the curve of the machine as it is
        self._mean = MeanLoads()  # of those for which the curve does not hold
        self._renewal = Renewal()
        self._range = SpeedRange()
        self._outdated_since = self._loaded_at = self._judged_at = self._held_at = -math.inf
        self._publisher = node.create_publisher(PointCloud2, "~/response_curve", LATCHED)
        self._arrays = node.create_publisher(JointState, "~/response_curve_arrays", LATCHED)
        node.create_service(Trigger, "~/recompute", self._recompute)
        node.create_timer(_POLL, self._poll, clock=Clock(clock_type=ClockType.STEADY_TIME))
        operation.after_change.append(self.look)

    @property
    def jumps(self) -> JumpMap | None:
        """Where the machine would jump; None where no curve tells."""
        return self._jumps if self.usable else None

    @property
    def usable(self) -> bool:
        """Whether the curve tells of the machine as it is now, or was a moment ago."""
        return self.holds or time.monotonic() - self._held_at < _HELD

    @property
    def age(self) -> float:
        """Time for which the curve has not been that of the machine [s]; NaN without a curve."""
        if self.result is None:
            return math.nan
        outdated = self.result.job.revision != self.revision
        return time.monotonic() - self._outdated_since if outdated else 0.0

    @property
    def outdated_for(self) -> float:
        """The same, but 0 where no more than a wider range is asked for."""
        result, present = self.result, self._present
        if result is not None and present is not None:
            known, asked = result.job, present
            if (known.machine, known.harmonics) == (asked.machine, asked.harmonics):
                return 0.0
        return self.age

    @property
    def revisions(self) -> dict[str, str]:
        """The revision of the machine, and that of the curve: 0 while there is none."""
        of_curve = self.result.job.revision if self.result else 0
        return {"revision": str(self.revision), "curve_revision": str(of_curve)}

    def look(self) -> None:
        """Note what curve is wanted now."""
        job, now = self._job(), time.monotonic()
        model = self._operation.model
        if job is None or model is None or job == self._present:
            return
        self._present, before = job, self._own
        self._own = model.machine, job.harmonics, job.lowest, job.highest, job.detached
        if self._own == before:  # so that it is the loads, which may change all the time
            self._loaded_at = now
            self._mean.add(model.loads)
            return
        self._mean = MeanLoads()
        self._want(now)
        self._judge(now)

    def added_to(self, status: Status) -> Status:
        """Return the status of the model with how its response curve fares."""
        values = {**status.values, "curve: age [s]": f"{self.age:.3g}", **self.revisions}
        if self.result is not None:
            values["curve: computed in [s]"] = f"{self.result.seconds:.3g}"
        message = status.message
        if self.outdated_for > 0.0:
            message += f"; the response curve is outdated by {self.outdated_for:.1f} s"
        return replace(status, message=message, values=values)

    @property
    def outside(self) -> str:
        """On which side of the curve the machine runs, in words; empty if it is on the curve."""
        if self.result is None or math.isnan(self._speed):
            return ""
        job = self.result.job
        where = outside(self._speed, job.lowest, job.highest)
        if not where:
            return ""
        wider = (self._range.lowest, self._range.highest) != (job.lowest, job.highest)
        if wider and not self.worker.failed:
            return f"{where}; a wider one is being computed"
        end = "speed.max" if self._speed > job.highest else "speed.min"
        return f"{where}: the parameter {end} moves that end"

    def range_in(self, inputs: Status) -> Status:
        """Return the status of the inputs with what there is to say of the speed's size."""
        doubt = self._range.doubt(self._speed, self._critical)
        said = (f"the speed is {self.outside}" if self.outside else "", doubt)
        words = "; ".join(part for part in (inputs.message, *said) if part)
        level = max(inputs.level, Level.WARN) if any(said) else inputs.level
        return replace(inputs, level=level, message=words)

    @property
    def _speed(self) -> float:
        """The speed that the machine is believed to have [rad/s]; NaN if none."""
        prediction = self._operation.believed
        return math.nan if self._operation.silence or not prediction else prediction.speed

    @property
    def _critical(self) -> float:
        return self.result.critical if self.result else math.nan

    def release(self) -> None:
        """Forget the curve, and end the worker process until there is another machine.

        Who comes later is to see no curve of a machine that is not there any more.
        """
        self.worker.close()
        if self.result is not None:
            self._publish((), ())
        self.result = self._jumps = self._own = self._present = None
        self.holds, self._held_at, self._landmarks = False, -math.inf, ()
        self._mean, self._renewal, self._range = MeanLoads(), Renewal(), SpeedRange()

    def _job(self) -> CurveJob | None:
        """What curve is wanted; None where there is no machine."""
        model, given = self._operation.model, self._parameters
        if model is None:
            return None
        operating = tuple(rpm * RPM for rpm in model.machine.operating_speed_rpm)
        self._range.configure(given["speed.min"], given["speed.max"], operating)
        return CurveJob(
            model.loaded,
            model.harmonics.highest,
            self._range.lowest,
            self._range.highest,
            given["curve.detached"],
            self.revision,
        )

    def _recompute(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Compute the curve anew at once, whether or not anything has changed."""
        response.success = self._present is not None
        if self._present is None:
            response.message = "refused, since there is no machine: the node is not configured"
        else:
            self._ask(exactly=True)
            response.message = "the response curve is being computed"
        return response

    def _poll(self) -> None:
        """Ask for a curve if it is time, and take one that has come."""
        if self._present is None:
            return
        hang, attempts = (self._parameters[f"curve.{key}"] for key in ("hang_after", "attempts"))
        self.worker.patience = Patience(hang, attempts=attempts)
        now = time.monotonic()
        self._follow_speed(now)
        self._follow_loads(now)
        self._trust()
        job = self.worker.job
        # While it looks for detached branches, the curve itself has come.
        busy = job is not None and not (self.result and self.result.job == job)
        if self._renewal.due(now, busy):
            self._ask(exactly=False)
        result = self.worker.poll()
        bug = self.worker.taken_bug()
        if bug:
            self._node.get_logger().error(f"unexpected error in the worker process:\n{bug}")
        if result is not None:
            self._adopt(result)

    def _follow_speed(self, now: float) -> None:
        """Want a wider curve where the machine leaves this one, but not for what was no speed."""
        speed = self._speed
        if math.isnan(speed) or self._range.doubt(speed, self._critical):
            return
        if self._range.follow(speed, self._operation.acceleration, now):
            self.look()

    def _follow_loads(self, now: float) -> None:
        """Judge the curve by the loads that have come, and want another where it does not hold."""
        new = self._loaded_at > self._judged_at
        if new and now - self._judged_at < _JUDGE:
            return
        if new:
            self._judge(now)
        if self.worker.failed:
            if new:  # with other loads there may be a curve
                self._want(now)
        elif self.result is None or self.age > 0.0:
            return
        elif not self.usable:
            self._want(now, at_once=True)
        elif self._rests(now):
            self._loaded_at, self._mean = -math.inf, MeanLoads()
            if self._present and self.result.job.machine != self._present.machine:
                self._renewal.change(now, first=True)  # for the curve of the very machine

    def _rests(self, now: float) -> bool:
        """Whether loads have come, and no other for a while."""
        return math.isfinite(self._loaded_at) and now - self._loaded_at > _QUIET

    def _want(self, now: float, at_once: bool = False) -> None:
        """Want the curve of another state of the machine, at once or when changes pause."""
        if not self.age > 0.0:  # nor where there is no curve yet
            self._outdated_since = now
        self.revision += 1
        self._present = self._job()
        first = self.result is None and self.worker.job is None
        self._renewal.change(now, first=first or at_once)

    def _ask(self, exactly: bool) -> None:
        """Have the worker process compute a curve: of the very machine, or of its mean loads."""
        job, model = self._present, self._operation.model
        assert job is not None
        assert model is not None
        if not exactly:
            job = replace(job, machine=model.loaded_by(self._mean.forces(model.loads)))
        self._mean = MeanLoads()
        self.worker.request(job)

    def _adopt(self, result: CurveResult) -> None:
        """Go by a new curve from now on, and publish it."""
        detached = result.detached or ()
        # A machine gets onto a detached branch when a shock throws it there, and then stays.
        curve = replace(result.curve, branches=(*result.curve.branches, *detached))
        self.result, self._jumps = result, jump_map(curve)
        self._landmarks = landmarks(result.curve)
        model = self._operation.model
        assert model is not None
        model.balance()
        model.tracker.adopt(curve)
        self._judge(time.monotonic())
        self._publish(result.curve.branches, detached)
        self._operation.predict_again()

    def _publish(self, branches: Sequence[CurveBranch], detached: Sequence[CurveBranch]) -> None:
        """Publish the branches of the newest result, or none of them."""
        assert self.result is not None
        now, revision = self._node.get_clock().now(), self.result.job.revision
        dampers = self.result.curve.dampers
        self._publisher.publish(response_curve_message(now, branches, detached, dampers, revision))
        self._arrays.publish(curve_arrays_message(now, branches, detached, revision))

    def _judge(self, now: float) -> None:
        """Find out whether the curve tells of the machine as it is now."""
        self._judged_at = now
        self.holds = self._holds()
        if self.holds:
            self._held_at = now
            self._mean = MeanLoads()
        self._trust()

    def _trust(self) -> None:
        """Let the tracker know whether the curve tells of the machine."""
        if self._operation.model is not None:
            self._operation.model.tracker.trusted = self.usable

    def _holds(self) -> bool:
        """Compare the machine with the curve: at its jumps, and where the machine is."""
        result, present, model = self.result, self._present, self._operation.model
        if result is None or present is None or model is None:
            return False
        if result.job.harmonics != present.harmonics:
            return False
        if result.job.machine == present.machine:
            return True
        try:
            with np.errstate(all="ignore"):  # where numbers overflow nothing holds
                balance = model.balance()
        except (ArithmeticError, ValueError):  # a machine beyond what numbers can hold
            return False
        place = model.tracker.place
        here = place.response if place else None
        responses = (*self._landmarks, *([here] if isinstance(here, Solution) else []))
        return deviation(balance, responses) <= HOLDS
