"""The response curve of the machine: asked for when it changes, adopted and published."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.messages.curve import response_curve_message
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult
from sfd_hbm_ros.node.worker.likeness import alike
from sfd_hbm_ros.node.worker.renewal import Renewal
from sfd_hbm_ros.node.worker.worker import Patience, Worker
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.warning.jump_map import JumpMap, jump_map

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Reliable, and the last message is there for whoever comes later."""

_POLL = 0.1  # s between two looks at the worker process


class Curves:
    """Keeps the response curve of the machine as new as it can be.

    A worker process computes it, soon after each change of the machine, its loads, the harmonics
    or the range. Until a new curve is whole the operation goes on with the old one.

    Parameters
    ----------
    node : LifecycleNode
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
    usable : bool
        Whether it tells of the machine as it is now.
    """

    def __init__(self, node: LifecycleNode, parameters: Parameters, operation: Operation) -> None:
        self.worker = Worker()
        self.result: CurveResult | None = None
        self.usable = False
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._jumps: JumpMap | None = None
        self._wanted: CurveJob | None = None
        self._renewal = Renewal()
        self._outdated_since = math.nan
        self._publisher = node.create_publisher(PointCloud2, "~/response_curve", LATCHED)
        node.create_service(Trigger, "~/recompute", self._recompute)
        node.create_timer(_POLL, self._poll, clock=Clock(clock_type=ClockType.STEADY_TIME))
        operation.after_change.append(self.look)

    @property
    def jumps(self) -> JumpMap | None:
        """Where the machine would jump; None where no curve tells."""
        return self._jumps if self.usable else None

    @property
    def age(self) -> float:
        """Time for which the curve has not been that of the machine [s]; NaN without a curve."""
        if self.result is None:
            return math.nan
        outdated = self.result.job != self._wanted
        return time.monotonic() - self._outdated_since if outdated else 0.0

    def look(self) -> None:
        """Note what curve is wanted now."""
        job, now = self._job(), time.monotonic()
        if job is None or job == self._wanted:
            return
        if not self.age > 0.0:  # nor where there is no curve yet
            self._outdated_since = now
        self._wanted = job
        self._judge()
        self._renewal.change(now, first=self.result is None and self.worker.job is None)

    def added_to(self, status: Status) -> Status:
        """Return the status of the model with how its response curve fares."""
        values = {**status.values, "curve: age [s]": f"{self.age:.3g}"}
        if self.result is not None:
            values["curve: computed in [s]"] = f"{self.result.seconds:.3g}"
        message = status.message
        if self.age > 0.0:
            message += f"; the response curve is outdated by {self.age:.1f} s"
        return replace(status, message=message, values=values)

    def release(self) -> None:
        """Forget the curve, and end the worker process until there is another machine.

        Who comes later is to see no curve of a machine that is not there any more.
        """
        self.worker.close()
        if self.result is not None:
            self._publish((), ())
        self.result = self._jumps = self._wanted = None
        self.usable = False
        self._renewal = Renewal()

    def _job(self) -> CurveJob | None:
        """What curve is wanted; None where there is no machine."""
        model, given = self._operation.model, self._parameters
        if model is None:
            return None
        return CurveJob(
            model.loaded,
            model.harmonics.highest,
            given["speed.min"],
            given["speed.max"],
            given["curve.detached"],
        )

    def _recompute(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Compute the curve anew at once, whether or not anything has changed."""
        response.success = self._wanted is not None
        if self._wanted is None:
            response.message = "refused, since there is no machine: the node is not configured"
        else:
            self.worker.request(self._wanted)
            response.message = "the response curve is being computed"
        return response

    def _poll(self) -> None:
        """Ask for a curve if it is time, and take one that has come."""
        if self._wanted is None:
            return
        hang, attempts = (self._parameters[f"curve.{key}"] for key in ("hang_after", "attempts"))
        self.worker.patience = Patience(hang, attempts=attempts)
        job = self.worker.job
        # While it looks for detached branches, the curve itself has come.
        busy = job is not None and not (self.result and self.result.job == job)
        if self._renewal.due(time.monotonic(), busy):
            self.worker.request(self._wanted)
        result = self.worker.poll()
        if result is not None:
            self._adopt(result)

    def _adopt(self, result: CurveResult) -> None:
        """Go by a new curve from now on, and publish it."""
        detached = result.detached or ()
        # A machine gets onto a detached branch when a shock throws it there, and then stays.
        curve = replace(result.curve, branches=(*result.curve.branches, *detached))
        self.result, self._jumps = result, jump_map(curve)
        self._judge()
        model = self._operation.model
        assert model is not None
        model.balance()
        model.tracker.adopt(curve)
        self._publish(result.curve.branches, detached)
        self._operation.predict_again()

    def _publish(self, branches: Sequence[CurveBranch], detached: Sequence[CurveBranch]) -> None:
        now = self._node.get_clock().now()
        self._publisher.publish(response_curve_message(now, branches, detached))

    def _judge(self) -> None:
        """Find out whether the curve tells of the machine as it is now."""
        result, wanted = self.result, self._wanted
        self.usable = bool(
            result
            and wanted
            and result.job.harmonics == wanted.harmonics
            and alike(result.job.machine, wanted.machine)
        )
