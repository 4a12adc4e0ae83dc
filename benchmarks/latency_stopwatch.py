"""The node of the latency benchmark that sends speeds, times predictions, and knows the curve."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from numpy.typing import NDArray
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from sensor_msgs.msg import JointState, PointCloud2

from sfd_hbm_ros.node.messages.common import read_stamp, speed_message

SECOND = 10**9
PERIOD = 10.0  # s of one run up and down
LOWEST, HIGHEST = 200.0, 600.0  # rad/s, which the runs go between
PATIENCE = 120.0  # s for anything that is waited for
LAST = 2.0  # s for the last predictions
_LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Stopwatch(Node):
    """Publishes speeds and notes when each left and when its prediction arrived.

    Attributes
    ----------
    curves : list of float
        When response curves came [s], by `time.monotonic`.
    computing : bool
        Whether the predictor says that its worker computes.
    """

    def __init__(self, namespace: str) -> None:
        super().__init__("latency", namespace=namespace)
        self.curves: list[float] = []
        self.computing = True
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self)
        self._left: dict[int, float] = {}
        self._took: dict[int, float] = {}
        self._speed = self.create_publisher(JointState, "predictor/speed", 1)
        self.create_subscription(JointState, "predictor/eccentricity", self._arrive, 100)
        self.create_subscription(PointCloud2, "predictor/response_curve", self._curve, _LATCHED)
        self.create_subscription(DiagnosticArray, "/diagnostics", self._diagnose, 100)
        service = "predictor/set_parameters_atomically"
        self._setting = self.create_client(SetParametersAtomically, service)

    def meet(self) -> None:
        """Publish speeds until predictions arrive and the predictor can be set."""
        ready = self._setting.service_is_ready
        self._until(lambda: bool(self._took) and ready(), "prediction", self._send)
        self.spin(1.0)

    def settle(self) -> None:
        """Wait until the curve is that of the machine, and nothing is being computed."""
        self.computing = True
        self._until(lambda: not self.computing and bool(self.curves), "response curve")

    def change(self, name: str, value: float) -> None:
        """Change a value of the machine."""
        parameters = [Parameter(name, value=value).to_parameter_msg()]
        self._setting.call_async(SetParametersAtomically.Request(parameters=parameters))

    def renewed_after(self, name: str, value: float) -> float:
        """Change a value of the machine and return the time until the next curve comes [s]."""
        begin, known = time.monotonic(), len(self.curves)
        self.change(name, value)
        self._until(lambda: len(self.curves) > known, "response curve")
        return self.curves[known] - begin

    def run(self, rate: float, seconds: float, between: Callable[[], None]) -> NDArray[np.float64]:
        """Publish speeds at a rate [Hz] and return the times [s], infinite for what was lost.

        `between` is called after each.
        """
        self._left.clear()
        self._took.clear()
        start = time.perf_counter()
        for i in range(round(rate * seconds)):
            self.spin(start + i / rate - time.perf_counter())
            self._send()
            between()
        self.spin(LAST)
        return np.array([self._took.get(stamp, math.inf) for stamp in self._left])

    def spin(self, seconds: float) -> None:
        """Take messages for a time [s]."""
        end = time.perf_counter() + seconds
        while (left := end - time.perf_counter()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def _until(
        self, condition: Callable[[], bool], what: str, between: Callable[[], None] | None = None
    ) -> None:
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"no {what} within {PATIENCE:g} s")
            if between is not None:
                between()
            self.spin(0.05)

    def _send(self) -> None:
        now = self.get_clock().now().nanoseconds
        phase = now / SECOND / PERIOD % 1.0
        speed = LOWEST + 2.0 * (HIGHEST - LOWEST) * min(phase, 1.0 - phase)
        message = speed_message(Time(nanoseconds=now), speed, 0.0)
        self._left[now] = time.perf_counter()
        self._speed.publish(message)

    def _arrive(self, message: JointState) -> None:
        stamp = read_stamp(message.header)
        if stamp in self._left and stamp not in self._took:
            self._took[stamp] = time.perf_counter() - self._left[stamp]

    def _curve(self, message: PointCloud2) -> None:
        self.curves.append(time.monotonic())

    def _diagnose(self, message: DiagnosticArray) -> None:
        name = f"{self.get_namespace().lstrip('/')}/predictor: Model"
        for status in message.status:
            if status.name == name:
                values = {pair.key: pair.value for pair in status.values}
                outdated = values.get("curve: age [s]") != "0"
                self.computing = outdated or "is being computed" in status.message
