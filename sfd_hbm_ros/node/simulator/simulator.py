"""Plays the machine: publishes the speed of a rotor on its runs up and down, and its orbit."""

from __future__ import annotations

import math
import sys

from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from sfd_hbm_ros.kernels import load_kernels
from sfd_hbm_ros.node import guard
from sfd_hbm_ros.node.messages.common import harmonics_message, speed_message
from sfd_hbm_ros.node.process import run, spin_until
from sfd_hbm_ros.node.simulator.disturbance import Disturbance
from sfd_hbm_ros.node.simulator.parameters import declare, take
from sfd_hbm_ros.node.simulator.played_machine import JumpError
from sfd_hbm_ros.node.simulator.simulation import play
from sfd_hbm_ros.response.errors import NoSolutionError

_QUEUE = 10
_PAUSE = 10.0  # s between two like log messages
_LAST_WORD = Duration(seconds=1.0)  # for the last speed to arrive
_PART = 0.8  # of the time between two speeds that the machine may take
_FRAME = "rotor"
_SECOND = 1_000_000_000  # ns


class Simulator(Node):
    """Publishes `predictor/speed` and `predictor/measured` as soon as its subscribers are there.

    Attributes
    ----------
    finished : Future
        Done at the end of the last coast-down.

    Raises
    ------
    MachineError
        If the value of a parameter is not allowed.
    NoSolutionError
        If the machine has no solution at an end of its run.
    """

    def __init__(self) -> None:
        super().__init__("simulator")
        self._settings, values = take(self)
        declare(self, self._settings, values)
        self._machine = play(self._settings, values, self._look_for_shutdown)
        self._disturbance = Disturbance(self._settings)
        self._speed = self.create_publisher(JointState, "predictor/speed", _QUEUE)
        self._measured = self.create_publisher(JointState, "predictor/measured", _QUEUE)
        self.create_service(Trigger, "~/jump", self._jump)
        guard.answer_always(self, lambda error: self.get_logger().warning(f"refused: {error}"))
        self._last: int | None = None  # ns, by the node's clock
        self._time = 0.0  # s of the run
        self._behind = 0.0  # s by which the run lags behind the clock
        self._orbit_due = 0.0  # s of the run
        self.finished = Future()
        self.create_timer(1.0 / self._settings.rate, self._tick)

    def _look_for_shutdown(self, speed: float) -> None:
        """Give up the response curve after a signal."""
        if not self.context.ok():
            raise ExternalShutdownException

    def _tick(self) -> None:
        """Publish the speed of this moment, once there is somebody to tell."""
        now = self.get_clock().now().nanoseconds
        if self._last is None:
            if not self._attended():
                return
            self._last = now
            self.get_logger().info(str(self._settings))
        wanted = self._time + max(0.0, (now - self._last) / _SECOND)
        self._last = now
        end = min(wanted, self._settings.duration)
        self._advance(end)
        self._publish(now - round((wanted - end) * _SECOND))
        if self._time >= self._settings.duration:
            self._speed.wait_for_all_acked(_LAST_WORD)
            self.finished.set_result(None)

    def _attended(self) -> bool:
        """Return whether the subscribers are there, and tell every few seconds if not."""
        wanted, there = self._settings.subscribers, self._speed.get_subscription_count()
        if there < wanted:
            message = f"waiting for subscribers on {self._speed.topic_name}: {there} of {wanted}"
            self.get_logger().info(message, throttle_duration_sec=_PAUSE)
        return there >= wanted

    def _advance(self, time: float) -> None:
        """Let the run go on to a time [s], or as far as the machine gets."""
        self._time = self._machine.advance(time, _PART / self._settings.rate)
        if self._time < time:
            self._behind += time - self._time
            self.get_logger().warning(
                f"the integration cannot keep up: {self._time:.1f} s of the run have taken "
                f"{self._behind:.1f} s longer, as of a machine that is slower to change its speed",
                throttle_duration_sec=_PAUSE,
            )

    def _publish(self, stamp: int) -> None:
        """Publish the speed and the angle with a stamp [ns], and the orbit if it is due."""
        # The orbit first: who compares it with the prediction at this speed then has it already.
        if self._time >= self._orbit_due:
            self._orbit_due = self._time + 1.0 / self._settings.orbit_rate
            self._publish_orbit(stamp)
        if not self._disturbance.loses():
            angle = self._settings.angle(self._time) % math.tau
            speed = self._disturbance.speed(self._settings.speed(self._time))
            self._speed.publish(speed_message(self._disturbed(stamp), speed, angle))

    def _publish_orbit(self, stamp: int) -> None:
        """Publish the orbit, if there is a machine."""
        journals = self._machine.journals()
        if journals and not self._disturbance.loses():
            measured = self._disturbance.journals(journals)
            self._measured.publish(harmonics_message(self._disturbed(stamp), _FRAME, measured))

    def _disturbed(self, stamp: int) -> Time:
        """Return the stamp that a message bears."""
        return Time(nanoseconds=self._disturbance.stamp(stamp))

    def _jump(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Throw the machine onto another stable response."""
        try:
            response.message = self._machine.jump()
            response.success = True
        except (JumpError, NoSolutionError) as error:
            response.message = str(error)
        self.get_logger().info(f"jump: {response.message}")
        return response


def main() -> int:
    """Run the simulator until the end of its last coast-down."""
    return run("simulator", _ready, _simulate)


def _ready() -> Simulator:
    """Return the node with its kernels loaded, as its run cannot wait for them."""
    load_kernels()
    return Simulator()


def _simulate(simulator: Simulator) -> int:
    """Spin the simulator until it has finished."""
    try:
        spin_until(simulator, simulator.finished)
    except RuntimeError as error:  # as rcl's errors are
        if not simulator.context.ok():  # a signal came while the machine was at work
            raise ExternalShutdownException from error
        if not isinstance(error, NoSolutionError):
            raise
        print(f"simulator: {error}", file=sys.stderr)
        return 1
    return 0
