"""Measured orbits: they settle the branch, and show how well the model agrees."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import replace

from rclpy.lifecycle import LifecycleNode
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.dropping import dropping
from sfd_hbm_ros.node.inputs import Feed, InputError
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.messages.measured import read_measured
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.prediction import Model, Prediction
from sfd_hbm_ros.response.tracking.measured import measured_eccentricities, unit_hint
from sfd_hbm_ros.response.tracking.settling import Judgement, Settling
from sfd_hbm_ros.response.tracking.tracked import Tracked
from sfd_hbm_ros.response.warning.settings import Level

_QUEUE = 10
_KEPT = 100  # predictions, among which that of a measured orbit's time is looked for


class Measurement:
    """Compares every measured orbit with the prediction whose stamp is nearest to its own.

    Parameters
    ----------
    node : LifecycleNode
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Who predicts.

    Attributes
    ----------
    feed : Feed
        What arrived, and what it said.
    """

    def __init__(self, node: LifecycleNode, parameters: Parameters, operation: Operation) -> None:
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._predicted: deque[tuple[int, Tracked]] = deque(maxlen=_KEPT)
        self._settling = Settling()
        self._publisher = node.create_lifecycle_publisher(JointState, "~/residual", _QUEUE)
        topic = node.create_subscription(JointState, "~/measured", self._take, _QUEUE)
        self.feed: Feed[Judgement] = Feed(topic.topic_name)
        operation.after_prediction.append(self._remember)
        operation.after_change.append(self._forget)

    def added_to(self, status: Status) -> Status:
        """Return the status of the model with how it agrees with what is measured."""
        judgement, now = self.feed.value, time.monotonic()
        stale_after = self._parameters["stale_after"]
        seen = self._operation.measurements.eccentricities(now, stale_after)
        values = {
            **status.values,
            **{f"measured: eccentricity {name}": f"{one:.6g}" for name, one in seen.items()},
        }
        if judgement is None or self.feed.age(now) > stale_after:
            return replace(status, values=values)
        agreement = judgement.agreement
        values["measured: disagreement"] = f"{agreement.disagreement:.3g}"
        values["measured: difference [of the clearance]"] = f"{agreement.difference:.3g}"
        message = f"{status.message}; {judgement.message}"
        level = Level.WARN if self._operation.seen.differs else Level.OK
        return replace(status, level=max(status.level, level), message=message, values=values)

    def _take(self, message: JointState) -> None:
        """Compare an orbit with its prediction, and settle the branch where it tells."""
        with dropping(self._node, self.feed):
            measured = read_measured(message)
            clock = int(self._node.get_clock().now().nanoseconds)
            given = messages.read_stamp(message.header)
            model = self._operation.model
            if model is None or not self._operation.active:
                return
            self._see(measured, model, abs(clock - (given or clock)) * 1e-9)
            if self._operation.speed.value is None or not self._predicted:
                return  # it is early, and nothing is wrong with it
            tracked = self._nearest(given or clock)
            judgement = self._settling.judge(measured, tracked, model.tracker.settled)
            if math.isnan(judgement.agreement.disagreement):
                raise InputError(judgement.message)
            now = time.monotonic()
            stamp = self.feed.accept(judgement, given, clock, now)
            self._operation.measurements.compare(judgement.agreement, now)
            residuals = judgement.agreement.residuals
            header = Time(nanoseconds=stamp), self._parameters["frame_id"]
            self._publisher.publish(messages.numbers_message(*header, residuals))
            if judgement.settles is not None:
                model.tracker.settle(judgement.settles)
                self._forget()
                self._operation.measurements.forget_model()
                self._operation.predict_again()

    def _see(self, measured: Mapping[str, float], model: Model, age: float) -> None:
        """Take what an orbit of an age [s] says whatever the model and the speed."""
        clearances = {damper.name: damper.clearance for damper in model.machine.dampers}
        if hint := unit_hint(measured, clearances):
            raise InputError(hint)
        if age <= self._parameters["stale_after"]:
            eccentricities = measured_eccentricities(measured, clearances)
            self._operation.measurements.see(eccentricities, time.monotonic())

    def _nearest(self, stamp: int) -> Tracked:
        """The operating point at a time [ns]."""
        silence = self._operation.silence
        if silence:
            raise InputError(f"nothing is predicted, as {silence}")
        at, tracked = min(self._predicted, key=lambda one: abs(one[0] - stamp))
        apart = abs(at - stamp) * 1e-9
        if apart > self._parameters["stale_after"]:
            raise InputError(f"its stamp is {apart:.3g} s from that of the nearest prediction")
        return tracked

    def _remember(self, prediction: Prediction, stamp: int) -> None:
        back = (self._predicted[-1][0] - stamp) * 1e-9 if self._predicted else 0.0
        if back > self._parameters["stale_after"]:
            self._forget()  # as the clock was set back
        if prediction.tracked is not None and not prediction.tracked.doubtful:
            self._predicted.append((stamp, prediction.tracked))

    def _forget(self) -> None:
        """Compare no orbit with what was predicted of a machine or on a branch that was."""
        self._predicted.clear()
