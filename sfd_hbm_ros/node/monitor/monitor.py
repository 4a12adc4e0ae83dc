"""Prints what the predictor publishes: a row each second and a summary at the end."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState

from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages import monitor as monitor_messages
from sfd_hbm_ros.node.messages.common import read_speed, read_stamp
from sfd_hbm_ros.node.monitor.run_record import RunRecord
from sfd_hbm_ros.node.monitor.run_text import HEADER, alarm, diagnosis, rows, summary
from sfd_hbm_ros.node.monitor.run_warnings import WarningRecord
from sfd_hbm_ros.node.process import run, spin_until

# Best effort, as it matches every publisher; deep, so that no burst is lost.
_QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
_WARNED_OF = ": Jump"  # subject of the diagnostics that repeats the warning
_LOOK = 0.1  # s between two looks for the end of the run
_FAREWELL = 0.5  # s for the last prediction, after the speed's publisher has gone
_PATIENCE = 60.0  # s to wait for the first speed
_READERS: dict[str, Callable[[JointState], Any]] = {
    "speed": read_speed,
    "eccentricity": monitor_messages.read_eccentricities,
    "harmonics": monitor_messages.read_x_amplitudes,
    "measured": monitor_messages.read_x_amplitudes,
}


class Monitor(Node):
    """Prints speeds, predictions, warnings of jumps and what the diagnostics say about them.

    Parameters
    ----------
    until_finished : bool
        Whether to finish with the run, or where none begins within a minute.

    Attributes
    ----------
    finished : Future
        Done at the end of the run.
    record : RunRecord
        The speeds, predictions and measured orbits that came.
    warnings : WarningRecord
        The warnings that came.
    """

    def __init__(self, until_finished: bool) -> None:
        # Without parameter services, nothing but its own messages can disturb it.
        super().__init__("monitor", start_parameter_services=False)
        self.record = RunRecord()
        self.warnings = WarningRecord()
        self.finished = Future()
        self._until_finished = until_finished
        self._quiet = 0.0  # s for which nobody has published the speed, or none has come yet
        self._levels: dict[str, int] = {}
        topics = {
            topic: self.create_subscription(
                JointState, f"predictor/{topic}", partial(self._take, topic), _QOS
            ).topic_name
            for topic in _READERS
        }
        self.speed_topic = topics["speed"]
        warning = "predictor/jump_warning"
        self.create_subscription(DiagnosticArray, warning, self._take_warning, _QOS)
        self.create_subscription(DiagnosticArray, "/diagnostics", self._take_diagnostics, _QOS)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0, self._print_news, clock=steady)
        self.create_timer(_LOOK, self._look_for_the_end, clock=steady)
        print(f"waiting for speeds on {self.speed_topic}\n{HEADER}", flush=True)

    def problem(self) -> str:
        """Return what was missing from the run as a sentence, nothing if all is well."""
        if self.record.speeds == 0:
            return f"no speed came on {self.speed_topic} within {_PATIENCE:g} s"
        if not self.record.points:
            return f"{self.record.speeds} speeds came on {self.speed_topic}, but no prediction"
        return ""

    def _take(self, topic: str, message: JointState) -> None:
        """Record a message."""
        with self._reading(topic):
            stamp, value = read_stamp(message.header), _READERS[topic](message)
            if topic == "measured":
                self.record.measure(stamp, value)
            elif (point := self.record.take(stamp, topic, value)) is not None:
                self.warnings.follow(point)

    def _take_warning(self, message: DiagnosticArray) -> None:
        """Print a warning that says something new."""
        with self._reading("jump_warning"):
            warning = monitor_messages.read_warning(message)
            if self.warnings.take(warning):
                print(alarm(warning), flush=True)

    def _take_diagnostics(self, message: DiagnosticArray) -> None:
        """Print what the predictor says about a subject whose level has changed."""
        for name, level, text in monitor_messages.read_diagnostics(message, "predictor"):
            if level != self._levels.get(name, 0) and not name.endswith(_WARNED_OF):
                print(diagnosis(name, level, text), flush=True)
            self._levels[name] = level

    @contextmanager
    def _reading(self, topic: str) -> Iterator[None]:
        """Ignore a message that cannot be read, and say so."""
        try:
            yield
        except InputError as error:
            problem = f"ignored on predictor/{topic}: {error}"
            self.get_logger().warning(problem, throttle_duration_sec=1.0)

    def _print_news(self) -> None:
        """Print the newest prediction, or speed, of the last second."""
        if self.record.news is not None:
            print(rows(self.record.news, self.warnings.newest), flush=True)
            self.record.news = None

    def _look_for_the_end(self) -> None:
        """Finish if the run has ended, or none begins."""
        begun = self.record.speeds > 0
        quiet = not (begun and self.count_publishers(self.speed_topic))
        self._quiet = self._quiet + _LOOK if quiet else 0.0
        if self._until_finished and self._quiet >= (_FAREWELL if begun else _PATIENCE):
            self._print_news()
            self.finished.set_result(None)


def main() -> int:
    """Run the monitor until the end of the run, SIGINT or SIGTERM."""
    return run("monitor", lambda: Monitor(_until_finished()), _watch)


def _until_finished() -> bool:
    """Return whether the command line asks to end with the run."""
    parser = argparse.ArgumentParser("monitor", description=__doc__)
    parser.add_argument(
        "--until-finished",
        action="store_true",
        help="end when the machine's run does; exit code 1 if nothing was predicted",
    )
    return bool(parser.parse_args(remove_ros_args()[1:]).until_finished)


def _watch(monitor: Monitor) -> int:
    """Spin the monitor, sum up and return the exit code."""
    try:
        spin_until(monitor, monitor.finished)
    except BrokenPipeError:  # who read the rows has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    finally:
        print(f"\n{summary(monitor.record, monitor.warnings)}", flush=True)
    problem = monitor.problem() if monitor.finished.done() else ""
    if problem:
        print(f"monitor: {problem}", file=sys.stderr)
    return 1 if problem else 0
