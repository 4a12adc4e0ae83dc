"""The node of the soak test that counts what the predictor says, and changes its machine."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Header

from sfd_hbm_ros.node.messages.common import read_stamp
from sfd_hbm_ros.node.messages.monitor import read_eccentricities, read_warning
from sfd_hbm_ros.node.monitor.run_point import DamperPoint, RunPoint
from sfd_hbm_ros.node.monitor.run_warnings import WarningRecord
from sfd_hbm_ros.units import RPM

_DEEP = 1000
_LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
# Values of the machine that are set in turn; with the least unbalance there is no jump.
_CHANGES = itertools.cycle(
    {"unbalance.disk_2.magnitude": unbalance, "dampers.damper_1.viscosity": viscosity}
    for unbalance in (5.0e-4, 4.2e-4, 5.039e-4)
    for viscosity in (0.028, 0.0285)
)


class SoakWatch(Node):
    """Counts and times messages.

    Attributes
    ----------
    took : list of float
        Times from the arrival of a speed here to that of its prediction [s].
    speeds : int
        Speeds that came.
    pause : float
        Longest time between two heartbeats [s].
    changes, refused : int
        Changes of the machine that were answered, and those that were refused.
    longest_answer : float
        Longest time for such an answer [s].
    curves : int
        Response curves that came.
    raised, cleared : int
        Times that the warning rose from OK, and fell back to it.
    """

    def __init__(self, namespace: str) -> None:
        super().__init__("soak", namespace=namespace)
        self.took: list[float] = []
        self.speeds = self.changes = self.refused = self.curves = 0
        self.raised = self.cleared = 0
        self.pause = self.longest_answer = 0.0
        self._warnings = WarningRecord()
        self._came: dict[int, tuple[float, float]] = {}  # speed and time by stamp
        self._received = {"eccentricity": 0, "harmonics": 0}
        self._predictions = 0
        self._beat = 0.0
        topic = "predictor/{}".format
        self.create_subscription(JointState, topic("speed"), self._on_speed, _DEEP)
        for name in self._received:
            self.create_subscription(JointState, topic(name), self._counter(name), _DEEP)
        self.create_subscription(Header, topic("heartbeat"), self._on_heartbeat, _DEEP)
        self.create_subscription(PointCloud2, topic("response_curve"), self._on_curve, _LATCHED)
        self.create_subscription(
            DiagnosticArray, topic("jump_warning"), self._on_warning, _LATCHED
        )
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, _DEEP)
        service = topic("set_parameters_atomically")
        self._setting = self.create_client(SetParametersAtomically, service)

    @property
    def jumps(self) -> int:
        """Jumps that were passed as expected."""
        return len(self._warnings.jumps)

    def met(self) -> bool:
        """Return whether the predictor is there and knows where the machine would jump."""
        return self.curves > 0 and self._beat > 0.0 and self._setting.service_is_ready()

    def change(self) -> None:
        """Change the machine."""
        values = next(_CHANGES)
        parameters = [Parameter(n, value=value).to_parameter_msg() for n, value in values.items()]
        request = SetParametersAtomically.Request(parameters=parameters)
        begin = time.monotonic()

        def answered(future: Future) -> None:
            self.changes += 1
            self.refused += not future.result().result.successful
            self.longest_answer = max(self.longest_answer, time.monotonic() - begin)

        self._setting.call_async(request).add_done_callback(answered)

    def reliable(self) -> dict[str, tuple[int, int]]:
        """Return how many messages were sent and received, by the topic."""
        return {topic: (self._predictions, count) for topic, count in self._received.items()}

    def _on_speed(self, message: JointState) -> None:
        self.speeds += 1
        self._came[read_stamp(message.header)] = message.velocity[0], time.monotonic()
        if len(self._came) > _DEEP:
            del self._came[next(iter(self._came))]

    def _counter(self, name: str) -> Callable[[JointState], None]:
        def count(message: JointState) -> None:
            self._received[name] += 1
            if name == "eccentricity":
                self._follow(message)

        return count

    def _follow(self, message: JointState) -> None:
        """Note the time of a prediction, and whether it shows a jump."""
        stamp = read_stamp(message.header)
        if stamp not in self._came:  # one caused by a change of the machine
            return
        speed, came = self._came.pop(stamp)
        self.took.append(time.monotonic() - came)
        dampers = {n: DamperPoint(*both, ()) for n, both in read_eccentricities(message).items()}
        self._warnings.follow(RunPoint(stamp, 0.0, speed / RPM, dampers))

    def _on_heartbeat(self, message: Header) -> None:
        now = time.monotonic()
        if self._beat:
            self.pause = max(self.pause, now - self._beat)
        self._beat = now

    def _on_curve(self, message: PointCloud2) -> None:
        self.curves += 1

    def _on_warning(self, message: DiagnosticArray) -> None:
        before, warning = self._warnings.newest, read_warning(message)
        self._warnings.take(warning)
        level = before.level if before else 0
        self.raised += level == 0 < warning.level
        self.cleared += level > 0 == warning.level

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        """Learn how many predictions were published."""
        name = f"{self.get_namespace().lstrip('/')}/predictor: Solver"
        for status in message.status:
            if status.name == name:
                values = {pair.key: pair.value for pair in status.values}
                self._predictions = int(values["predictions"])
