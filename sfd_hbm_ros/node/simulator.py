"""Plays the machine: publishes the speed of a rotor that runs up and coasts down."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Annotated

import rclpy
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.machine.errors import show_key, unknown
from sfd_hbm_ros.machine.parts import read
from sfd_hbm_ros.machine.rules import integer, number
from sfd_hbm_ros.node import guard
from sfd_hbm_ros.node.messages import speed_message
from sfd_hbm_ros.node.process import run
from sfd_hbm_ros.node.speed_profile import SpeedProfile

_QUEUE = 10
_PAUSE = 10.0  # s between two like log messages
_LAST_WORD = Duration(seconds=1.0)  # for the last speed to arrive


@dataclass(frozen=True)
class Settings(SpeedProfile):
    """The simulator's parameters."""

    rate: Annotated[float, number("speeds a second", "Hz", least=0.1, below=1e4)] = 50.0
    subscribers: Annotated[int, integer("subscribers to wait for", least=0)] = 1


class Simulator(Node):
    """Publishes the speed on `predictor/speed` as soon as its subscribers are there.

    Attributes
    ----------
    finished : Future
        Done at the end of the coast-down.

    Raises
    ------
    MachineError
        If the value of a parameter is not allowed.
    """

    def __init__(self) -> None:
        super().__init__("simulator")
        self._settings = read(Settings, self._given(), "")
        self._declare()
        guard.answer_always(self, lambda error: self.get_logger().warning(f"refused: {error}"))
        self._speed = self.create_publisher(JointState, "predictor/speed", _QUEUE)
        self._start: Time | None = None
        self.finished = Future()
        self.create_timer(1.0 / self._settings.rate, self._tick)

    def _given(self) -> dict[str, object]:
        """Return the settings given at the start, and warn of parameters that are none."""
        given = {}
        for name, parameter in self._parameter_overrides.items():
            if name in Settings.rules:
                given[name] = parameter.value
            elif not self.has_parameter(name):  # as every node has use_sim_time
                problem = f"parameter {show_key(name)} {unknown(name, Settings.rules)}"
                self.get_logger().warning(f"{problem}; it has no effect")
        return given

    def _declare(self) -> None:
        """Show the settings, and what they mean, as parameters that stay as they are."""
        for key, rule in Settings.rules.items():
            about = f"{rule.about}: {rule.allowed}"
            descriptor = ParameterDescriptor(description=about, read_only=True)
            value = getattr(self._settings, key)
            self.declare_parameter(key, value, descriptor, ignore_override=True)

    def _tick(self) -> None:
        """Publish the speed of this moment, once there is somebody to tell."""
        now = self.get_clock().now()
        if self._start is None:
            if not self._attended():
                return
            self._start = now
            self.get_logger().info(str(self._settings))
        elapsed = (now - self._start).nanoseconds * 1e-9
        self._publish(self._start, min(elapsed, self._settings.duration))
        if elapsed >= self._settings.duration:
            self._speed.wait_for_all_acked(_LAST_WORD)
            self.finished.set_result(None)

    def _attended(self) -> bool:
        """Return whether the subscribers are there, and tell every few seconds if not."""
        wanted, there = self._settings.subscribers, self._speed.get_subscription_count()
        if there < wanted:
            message = f"waiting for subscribers on {self._speed.topic_name}: {there} of {wanted}"
            self.get_logger().info(message, throttle_duration_sec=_PAUSE)
        return there >= wanted

    def _publish(self, start: Time, time: float) -> None:
        """Publish the speed and the angle at a time [s] since the start."""
        stamp = start + Duration(seconds=time)
        angle = self._settings.angle(time) % math.tau
        self._speed.publish(speed_message(stamp, self._settings.speed(time), angle))


def main() -> int:
    """Run the simulator until the end of its coast-down."""
    return run("simulator", Simulator, _simulate)


def _simulate(simulator: Simulator) -> int:
    """Spin the simulator until it has finished."""
    rclpy.spin_until_future_complete(simulator, simulator.finished)
    return 0


if __name__ == "__main__":
    sys.exit(main())
