"""An example of a node that commands the predictor: change, ask, wait, acknowledge.

The rotor has been balanced, and the predictor is to go by what is left. With a predictor running:

    ros2 run sfd_hbm_ros supervisor --ros-args -p station:=disk_2 -p magnitude:=2.0e-4

Copy it, and put decisions of your own between the steps of `supervise`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from sfd_hbm_ros.node.process import run
from sfd_hbm_ros.units import RPM

_QUEUE = 10
# As the predictor publishes them: the last message is there for whoever comes later.
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Supervisor(Node):
    """Sets an unbalance, asks what the machine would do, and acknowledges the alarm.

    Its predictor is the node `predictor` in the same namespace.
    """

    def __init__(self) -> None:
        super().__init__("supervisor")
        self.station: str = self.declare_parameter("station", "disk_2").value
        self.magnitude: float = self.declare_parameter("magnitude", 4.319e-4).value  # kg m
        self.phase: float = self.declare_parameter("phase", 0.0).value  # rad
        self.rpm: float = self.declare_parameter("rpm", 4000.0).value
        self.patience: float = self.declare_parameter("patience", 60.0).value  # s, for each step
        self._setter = AsyncParameterClient(self, "predictor")
        self._acknowledge = self.create_client(Trigger, "predictor/acknowledge")
        self._question = self.create_publisher(JointState, "predictor/what_if/request", _QUEUE)
        # The newest message of each topic.
        self._answer = self._newest(JointState, "predictor/what_if/result", _QUEUE)
        self._curve = self._newest(PointCloud2, "predictor/response_curve", _LATCHED)
        self._warning = self._newest(DiagnosticArray, "predictor/jump_warning", _LATCHED)

    def supervise(self) -> int:
        """Go through the steps; return the exit code, 1 where one of them fails."""
        say = self.get_logger()
        try:
            self._wait(self._predictor_found, "the predictor")
            revision = self.set_unbalance()
            changed = self.get_clock().now()
            say.info(f"{self.station} now has {self.magnitude:g} kg m at {self.phase:g} rad")
            for name, value in self.ask(changed).items():
                say.info(f"at {self.rpm:g} rpm {name} would be {value:.3f} of the clearance")
            self._wait(lambda: self._curve_revision() >= revision, "its response curve")
            say.info(f"its response curve has {self._curve[0].width} points")
            say.info(f"the alarm: {self.acknowledge()}")
        except RuntimeError as error:
            say.error(str(error))
            return 1
        return 0

    def set_unbalance(self) -> int:
        """Set magnitude and phase together: both, or neither for a reason.

        Returns
        -------
        The revision of the machine with them, which its response curve will bear. Where it had
        them before, that is the curve which is there, or on its way.

        Raises
        ------
        RuntimeError
            If they are refused.
        """
        place = f"unbalance.{self.station}"
        values = [
            Parameter(f"{place}.magnitude", value=self.magnitude),
            Parameter(f"{place}.phase", value=self.phase),
        ]
        result = self._result(self._setter.set_parameters_atomically(values)).result
        if not result.successful:
            raise RuntimeError(f"the unbalance is refused: {result.reason}")
        _, _, revision = result.reason.partition("revision ")
        if not revision:
            raise RuntimeError("the predictor has no machine: it is not configured")
        return int(revision)

    def ask(self, stamp: Time) -> dict[str, float]:
        """Return the eccentricities at another speed; the answer has the question's stamp.

        Where the machine has just changed, the answer waits until the new curve is there.

        Raises
        ------
        RuntimeError
            If there is none, for a reason.
        """
        header = Header(stamp=stamp.to_msg())
        self._question.publish(JointState(header=header, velocity=[self.rpm * RPM]))
        self._wait(
            lambda: self._answer and self._answer[0].header.stamp == header.stamp, "an answer"
        )
        answer = dict(zip(self._answer[0].name, self._answer[0].position, strict=True))
        for name in answer:
            if name.startswith("reason: "):
                raise RuntimeError(f"there is no answer, as {name.removeprefix('reason: ')}")
        return answer

    def acknowledge(self) -> str:
        """Acknowledge the alarm, and return what the predictor says to it."""
        message: str = self._result(self._acknowledge.call_async(Trigger.Request())).message
        return message

    def _curve_revision(self) -> int:
        """Return the revision of the machine that the newest curve is of; 0 without a curve."""
        if not (self._curve and self._curve[0].width):
            return 0
        cloud = self._curve[0]
        [offset] = [field.offset for field in cloud.fields if field.name == "revision"]
        return int.from_bytes(bytes(cloud.data[offset : offset + 4]), "little")

    def _predictor_found(self) -> bool:
        """Return whether nothing that is said to the predictor, or by it, is lost from now on."""
        return bool(
            self._setter.services_are_ready()
            and self._acknowledge.service_is_ready()
            and self._question.get_subscription_count()
            and self.count_publishers("predictor/what_if/result")
            and self._warning
        )

    def _newest(self, kind: Any, topic: str, qos: QoSProfile | int) -> list[Any]:
        """Return a list that holds the newest message of a topic as soon as there is one."""
        kept: list[Any] = []

        def keep(message: Any) -> None:
            kept[:] = [message]

        self.create_subscription(kind, topic, keep, qos)
        return kept

    def _result(self, future: Future) -> Any:
        """Wait for the result of a call."""
        self._wait(future.done, "an answer")
        return future.result()

    def _wait(self, condition: Callable[[], Any], what: str) -> None:
        """Let messages come in until a condition holds."""
        end = time.monotonic() + self.patience
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError(f"waited {self.patience:g} s for {what} in vain")
            rclpy.spin_once(self, timeout_sec=0.1)


def main() -> int:
    """Supervise once, and end."""
    return run("supervisor", Supervisor, Supervisor.supervise)


if __name__ == "__main__":
    sys.exit(main())
