"""The work of the predictor: what arrives, and what is predicted and published of it."""

from __future__ import annotations

import time
from collections.abc import Callable

from geometry_msgs.msg import WrenchStamped
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.machine import Load, Machine
from sfd_hbm_ros.node.dropping import dropping
from sfd_hbm_ros.node.inputs import Feed, InputError, Pending
from sfd_hbm_ros.node.lean_node import LeanNode
from sfd_hbm_ros.node.messages import common as messages
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.prediction import Model, Prediction
from sfd_hbm_ros.response.tracking.excursion import RETURN
from sfd_hbm_ros.response.tracking.measurements import Measurements, Seen
from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator

_QUEUE = 10
_DAY = 86400.0  # s


class Operation:
    """Predicts at the newest speed whenever a speed, a load or a value of the machine changes.

    Its topics live as long as the node, since it takes up to seconds until they are found. What
    arrives is used as far as the node's state allows.

    Parameters
    ----------
    node : LeanNode
        The node.
    parameters : Parameters
        The node's parameters.

    Attributes
    ----------
    active : bool
        Whether to predict.
    model : Model or None
        The machine; None while there is none.
    prediction : Prediction or None
        The last one since the node became active.
    predictions, failures : int
        How many there were, and how many of them without a solution.
    remembered : int or None
        Stamp of what is known of the machine from before a restart, until a speed comes [ns].
    speed, load : Feed
        What arrived.
    measurements : Measurements
        What measured orbits say of the machine, by `time.monotonic`.
    after_change : list of callable
        Called when the machine has changed: another one, other values, loads or harmonics.
    after_forgetting : list of callable
        Called when what was known of the machine is not believed any more.
    after_prediction : list of callable
        Called with every prediction and its stamp [ns], once it has been published.
    """

    def __init__(self, node: LeanNode, parameters: Parameters) -> None:
        self.active = False
        self.model: Model | None = None
        self.prediction: Prediction | None = None
        self._believed: Prediction | None = None
        self.predictions = 0
        self.failures = 0
        self.after_change: list[Callable[[], None]] = []
        self.after_forgetting: list[Callable[[], None]] = []
        self.after_prediction: list[Callable[[Prediction, int], None]] = []
        self.remembered: int | None = None
        self._heard: float | None = None  # when the last speed came, by the steady clock [s]
        self.measurements = Measurements()
        self._estimator = AccelerationEstimator()
        self._node = node
        self._parameters = parameters
        self._pending: Pending[int] = Pending(parameters["publish_rate"])
        self._eccentricity = node.create_lifecycle_publisher(JointState, "~/eccentricity", _QUEUE)
        self._harmonics = node.create_lifecycle_publisher(JointState, "~/harmonics", _QUEUE)
        newest = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        speed = node.create_subscription(JointState, "~/speed", self._on_speed, newest)
        load = node.create_subscription(WrenchStamped, "~/load", self._on_load, _QUEUE)
        self.speed: Feed[float] = Feed(speed.topic_name)
        self.load: Feed[tuple[float, float]] = Feed(load.topic_name)
        # The period is set when it is needed; the node's own clock may stand still.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._due = node.create_timer(1.0, self._predict, clock=steady, autostart=False)

    @property
    def acceleration(self) -> float:
        """Angular acceleration [rad/s2]; NaN while it is unknown."""
        return self._estimator.acceleration

    @property
    def settled(self) -> bool:
        """Whether the acceleration has settled since a start or a reversal."""
        return self._estimator.settled

    @property
    def seen(self) -> Seen:
        """What measured orbits say now."""
        warn, stale_after = (self._parameters[key] for key in ("measured.warn", "stale_after"))
        return self.measurements.seen(warn, time.monotonic(), stale_after)

    @property
    def silence(self) -> str:
        """Why nothing is predicted now, in words; empty if something is."""
        if not self.active:
            return "the node is not active"
        if self.speed.value is None:
            return "no speed has arrived yet"
        stale = self.speed.age(time.monotonic()) > self._parameters["stale_after"]
        return "the speed is stale" if stale else ""

    @property
    def believed(self) -> Prediction | None:
        """The last prediction, but for those at speeds that have just leapt away."""
        tracked = self.prediction.tracked if self.prediction else None
        if tracked and tracked.doubtful and self.speed.age(time.monotonic()) < RETURN:
            return self._believed
        return self.prediction

    def begin(self, machine: Machine) -> Model:
        """Have another machine, which is not predicted yet."""
        self.model = model = Model(machine, self._parameters["harmonics"])
        self._changed()
        return model

    def change(self, machine: Machine) -> None:
        """Go on with other values of the machine or other harmonics, and predict soon."""
        assert self.model is not None
        self.model.change(machine, self._parameters["harmonics"])
        self._changed()
        self.predict_again()

    def add(self, load: Load) -> None:
        """Let a load of the machine act, in place of any other at its station."""
        assert self.model is not None
        if self.model.add(load):
            self._changed()

    def stop(self) -> None:
        """Predict no more, and wait for another speed at the next start.

        The operating point is kept as it would be over a restart of the node: the machine goes on.
        """
        self.active = False
        self.prediction = self._believed = None
        self.speed.forget()
        self._estimator.forget()
        self.measurements.forget()

    def release(self) -> None:
        """Stop, and forget the machine and its loads."""
        self.stop()
        self.model = self.remembered = self._heard = None
        self.load.forget()

    def update(self) -> None:
        """Take account of changed parameters."""
        self._pending.rate = self._parameters["publish_rate"]

    def predict_again(self) -> None:
        """Predict once more as something has changed: soon, whoever changed it hears first."""
        if not self._pending.waits:  # whose stamp is that of an input
            self._pending.put(self._clock())
        self._schedule()

    def _on_speed(self, message: JointState) -> None:
        if not self.active:
            return
        with dropping(self._node, self.speed):
            speed = messages.read_speed(message)
            if self.model is not None:
                self.model.rim.check(speed, self._parameters["speed.max"])
            stamp = messages.read_stamp(message.header)
            stamp = self.speed.accept(speed, stamp, self._clock(), time.monotonic())
            self._doubt_history(stamp)
            self._estimator.add(stamp, speed)
            self._request(stamp)

    def _doubt_history(self, stamp: int) -> None:
        """Believe no more what is known of a machine that was not seen for long before a stamp."""
        age, now = 0.0, time.monotonic()
        if self.remembered is not None:
            age = (stamp - self.remembered) * 1e-9
        elif self._heard is not None:
            age = now - self._heard
        self.remembered, self._heard = None, now
        problem = self.too_old(age)
        if problem and self.model is not None:
            self.model.tracker.forget()
            for call in self.after_forgetting:
                call()
            self._node.get_logger().warning(f"the branch is not believed any more: {problem}")

    def too_old(self, age: float) -> str:
        """Return why what was known of a machine so long ago [s] is not believed; empty if it is.

        A clock may be a second ahead of another.
        """
        limit = self._parameters["state_max_age"]
        if age < -1.0:
            return "the machine was last seen at a time that is still to come"
        if age > limit:
            ago = f"{age:.0f} s" if age < 2.0 * _DAY else f"{age / _DAY:.0f} days"
            return f"the machine was last seen {ago} ago, longer than state_max_age, {limit:g} s"
        return ""

    def _on_load(self, message: WrenchStamped) -> None:
        with dropping(self._node, self.load):
            if self.model is None:
                raise InputError("there is no machine yet: the node is not configured")
            load = self.model.checked_load(*messages.read_load(message))
            stamp = messages.read_stamp(message.header)
            # The loads of several stations may come from several publishers.
            stamp = self.load.accept(
                load.force, stamp, self._clock(), time.monotonic(), stream=load.station
            )
            self.add(load)
            self._request(stamp)

    def _changed(self) -> None:
        for call in self.after_change:
            call()

    def _request(self, stamp: int) -> None:
        """Predict with a stamp [ns], now or as soon as the rate allows it."""
        self._pending.put(stamp)
        if self._pending.wait(time.monotonic()) > 0.0:
            self._schedule()
        else:
            self._predict()

    def _schedule(self) -> None:
        """Have the timer predict when the rate allows it."""
        self._due.timer_period_ns = int(self._pending.wait(time.monotonic()) * 1e9)
        self._due.reset()

    def _predict(self) -> None:
        """Predict and publish, if the node is active and the speed fresh."""
        self._due.cancel()
        stamp, speed = self._pending.take(time.monotonic()), self.speed.value
        if self.silence or self.model is None or stamp is None or speed is None:
            return
        self._believed = self.believed
        self.prediction = prediction = self.model.predict(speed, stamp * 1e-9)
        self.predictions += 1
        self.failures += prediction.failed
        if prediction.bug is not None:
            self._node.mishaps.take(prediction.bug)
        header = Time(nanoseconds=stamp), self._parameters["frame_id"]
        journals = prediction.journals
        seen = self.measurements.eccentricities(time.monotonic(), self._parameters["stale_after"])
        self._eccentricity.publish(
            messages.eccentricity_message(*header, journals, prediction.others, speed, seen)
        )
        self._harmonics.publish(messages.harmonics_message(*header, journals))
        for call in self.after_prediction:
            call(prediction, stamp)
        if prediction.tracked and prediction.tracked.wrong_before:
            with dropping(self._node, self.speed):
                raise InputError("a speed leapt away and was back at once, so it was wrong")

    def _clock(self) -> int:
        """Return the time by the node's clock [ns]."""
        return int(self._node.get_clock().now().nanoseconds)
