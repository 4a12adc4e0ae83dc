"""The node that stands for a machine: it publishes speeds and hears the warning."""

from __future__ import annotations

import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState, PointCloud2

from benchmarks.warned import NOISE, RATE, slip
from sfd_hbm_ros.node.messages.common import speed_message
from sfd_hbm_ros.node.messages.monitor import read_warning
from sfd_hbm_ros.response.integration.ramp import Ramp

PATIENCE = 300.0  # s until the predictor has its response curve
ENTRY, REST = 6.0, 8.0  # s on the way to the start of a run, and there
_LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class WarnedMachine(Node):
    """Publishes noisy speeds in real time and notes when the warning rises and falls.

    Parameters
    ----------
    namespace : str
        That of the predictor.
    rng : Generator
        What makes the noise.
    wrong : float
        Part of the speeds that is measured as half or twice.
    load : (str, float), optional
        Station and rms of a load of mean 0 that comes ten times a second [N].

    Attributes
    ----------
    late : float
        How late a speed of the run was published at most [s].
    """

    def __init__(
        self,
        namespace: str,
        rng: np.random.Generator,
        wrong: float = 0.0,
        load: tuple[str, float] | None = None,
    ) -> None:
        super().__init__("machine", namespace=namespace)
        self.late = 0.0
        self._rng, self._wrong = rng, wrong
        self._curves = 0
        self._warned = False
        self._changes: list[float] = []  # by time.monotonic [s]
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self)
        self._speed = self.create_publisher(JointState, "predictor/speed", 1)
        self._load = self.create_publisher(WrenchStamped, "predictor/load", 1)
        if load is not None:
            self.create_timer(0.1, lambda: self._send_load(*load))
        topic = "predictor/{}".format
        self.create_subscription(
            DiagnosticArray, topic("jump_warning"), self._on_warning, _LATCHED
        )
        self.create_subscription(PointCloud2, topic("response_curve"), self._on_curve, _LATCHED)

    def enter(self, first: float, start: float) -> None:
        """Wait for the response curve, then go from one speed to another [rad/s] and rest there.

        Raises
        ------
        TimeoutError
            If no curve comes.
        """
        patience = time.monotonic() + PATIENCE
        while not self._curves:
            if time.monotonic() > patience:
                raise TimeoutError(f"no response curve within {PATIENCE:g} s")
            self._send(first, time.monotonic() + 0.1)
        for part in np.minimum(np.arange(0.0, ENTRY + REST, 1.0 / RATE) / ENTRY, 1.0).tolist():
            self._send(first + part * (start - first), time.monotonic() + 1.0 / RATE)

    def run(self, ramp: Ramp, end: float) -> list[float]:
        """Run until a time and return when the warning rose and fell in turns before it [s]."""
        begin = time.monotonic()
        self._changes = [begin] if self._warned else []
        for now in np.arange(0.0, end, 1.0 / RATE).tolist():
            self.late = max(self.late, time.monotonic() - begin - now)
            self._send(ramp.start + ramp.acceleration * now, begin + now + 1.0 / RATE)
        return [change - begin for change in self._changes]

    def _send(self, speed: float, until: float) -> None:
        """Publish a speed [rad/s] with noise, and listen until a time."""
        measured = (speed + self._rng.normal(0.0, NOISE)) * slip(self._rng, self._wrong)
        self._speed.publish(speed_message(self.get_clock().now(), measured, 0.0))
        while (left := until - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def _send_load(self, station: str, rms: float) -> None:
        """Publish a random load [N]."""
        message = WrenchStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = station
        message.wrench.force.x, message.wrench.force.y = self._rng.normal(0.0, rms, 2).tolist()
        self._load.publish(message)

    def _on_warning(self, message: DiagnosticArray) -> None:
        warned = read_warning(message).level > 0
        if warned != self._warned:
            self._warned = warned
            self._changes.append(time.monotonic())

    def _on_curve(self, message: PointCloud2) -> None:
        self._curves += 1
