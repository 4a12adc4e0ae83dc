"""Predictor, simulator and monitor together, and the monitor alone."""

import math
import re
import signal
import sys
from collections.abc import Callable

import pytest

from .graph import DiagnosticArray, Graph, JointState, Time
from .process import PAPER_ROTOR

# isort: split
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, read_machine
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.messages.common import diagnostics_message, speed_message
from sfd_hbm_ros.node.monitor import monitor
from sfd_hbm_ros.response.warning.settings import Level

RPM = math.pi / 30.0  # rad/s
LIMIT = 60.0  # s
UNBALANCE = 4e-3  # kg m: so much that 3x shows


@pytest.fixture(scope="module")
def demo(start_node) -> list[str]:
    """The lines of the monitor during a short run under gravity, after all have ended well."""
    machine = f"machine_file:={PAPER_ROTOR} gravity:=true unbalance.disk_2.magnitude:={UNBALANCE}"
    run = "from_rpm:=2000 to_rpm:=2400 rpm_per_second:=100 hold:=3 subscribers:=2"
    parameters = {"predictor": machine, "simulator": f"{machine} {run}"}
    ros = ["--ros-args", "-r", "__ns:=/demo"]
    predictor, simulator = (
        start_node(node, *ros, *(part for value in text.split() for part in ("-p", value)))
        for node, text in parameters.items()
    )
    monitor = start_node("monitor", "--until-finished", *ros)
    assert simulator.wait(LIMIT) == 0
    assert monitor.wait(LIMIT) == 0
    assert predictor.stop(signal.SIGINT) == 0
    assert "Traceback" not in predictor.said() + monitor.said() + simulator.said()
    return monitor.said().splitlines()


def rows(lines: list[str]) -> list[list[str]]:
    """The fields of the lines that show a prediction."""
    return [line.split() for line in lines if re.match(r" *\d+\.\d +\d+  damper_1 ", line)]


def test_a_row_is_printed_each_second(demo):
    times = [float(row[0]) for row in rows(demo)]
    assert times == sorted(times)
    assert 5 <= len(times) <= 13
    # s: 4 up, 3 there, 4 down; speeds are best effort, and a busy computer may lose the very last
    assert 10.5 <= times[-1] <= 11.1


def test_a_row_shows_what_solve_finds(demo):
    (row, *_) = [row for row in rows(demo) if row[1] == "2400" and 4.0 < float(row[0]) < 7.0]
    machine = override(read_machine(PAPER_ROTOR), "gravity", True)
    machine = override(machine, "unbalance.disk_2.magnitude", UNBALANCE)
    solution = solve(HarmonicBalance(machine, Harmonics(7)), 2400.0 * RPM)
    journal = solution.journals["damper_1"]
    eccentricity, other, first, measured, *higher = row[3:9]
    assert float(eccentricity) == pytest.approx(journal.eccentricity_max, abs=0.51e-4)
    assert other == "-"
    amplitudes = [math.hypot(journal.cos[n, 0], journal.sin[n, 0]) * 1e6 for n in (1, 2, 3)]
    assert min(amplitudes) > 0.05
    assert [float(text) for text in (first, *higher)] == pytest.approx(amplitudes, abs=0.51e-2)
    assert float(measured) == pytest.approx(amplitudes[0], abs=0.51e-2)


def test_summary(demo):
    counted = re.fullmatch(r"(\d+) speeds, (\d+) predictions, 0 of them .*", demo[-5])
    assert counted
    speeds, predictions = map(int, counted.groups())
    assert 0.5 < speeds / (50 * 11) < 1.05
    assert 0.3 * speeds < predictions <= speeds
    assert re.fullmatch(
        r"damper_1, on the way up: peak eccentricity 0\.\d{4} at 2\d+ rpm", demo[-4]
    )
    assert re.fullmatch(r"damper_1, up and down differ by at most 0\.000\d, at \d+ rpm", demo[-2])
    apart = re.fullmatch(r"damper_1, \d+ measured orbits: 1x of x .* by (\S+) % .*", demo[-1])
    assert apart
    assert float(apart[1]) < 1e-3


def test_without_a_predictor_the_monitor_says_so(start_node):
    nodes = ["--ros-args", "-r", "__ns:=/alone"]
    monitor = start_node("monitor", "--until-finished", *nodes)
    start_node("simulator", *nodes, "-p", "to_rpm:=2000", "-p", "hold:=1.5")
    assert monitor.wait(LIMIT) == 1
    assert re.search(r"^ +\d\.\d +2000  no prediction$", monitor.said(), re.MULTILINE)
    assert "speeds came on /alone/predictor/speed, but no prediction" in monitor.said()


def test_without_a_machine_the_monitor_gives_up(domain, monkeypatch, capsys):
    monkeypatch.setattr(monitor, "_PATIENCE", 0.3)
    monkeypatch.setattr(sys, "argv", ["monitor", "--until-finished"])
    assert monitor.main() == 1
    assert capsys.readouterr().err == "monitor: no speed came on /predictor/speed within 0.3 s\n"


class PlayedPredictor:
    """Publishes what a predictor in a namespace would."""

    def __init__(self, graph: Graph, namespace: str) -> None:
        topics = ("speed", "eccentricity", "harmonics")
        self._publishers = {
            topic: graph.node.create_publisher(JointState, f"{namespace}/predictor/{topic}", 10)
            for topic in topics
        }
        self._diagnostics = graph.node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        topic = f"{namespace}/predictor/jump_warning"
        self._warnings = graph.node.create_publisher(DiagnosticArray, topic, 10)
        self._stamp = 0

    def predict(self, eccentricity: float) -> None:
        """Publish a prediction at 3000 rpm, a second after the one before."""
        self._stamp += 1_000_000_000
        numbers = {
            "eccentricity": {"a/max": eccentricity, "a/other_branch/max": 0.25},
            "harmonics": {"a/x/0x": 9.0, "a/x/1x/amplitude": 2e-6, "a/y/1x/amplitude": 9.0},
        }
        stamp = Time(nanoseconds=self._stamp)
        self._publishers["speed"].publish(speed_message(stamp, 3000.0 * RPM, 0.0))
        for topic, named in numbers.items():
            message = JointState(name=list(named), position=list(named.values()))
            message.header.stamp = stamp.to_msg()
            self._publishers[topic].publish(message)

    def publish_nonsense(self) -> None:
        """Publish names without numbers."""
        for topic in ("eccentricity", "harmonics"):
            self._publishers[topic].publish(JointState(name=["a/max"]))

    def warn(self, level: Level, rpm: float) -> None:
        """Publish that a jump is expected at a speed."""
        values = {"next_jump": "run_up", "next_jump_rpm": f"{rpm}", "time_to_jump_s": "2.5"}
        status = Status("Jump", level, f"Jump expected at {rpm} rpm", values)
        stamp = Time(nanoseconds=self._stamp)
        self._warnings.publish(diagnostics_message(stamp, "predictor", "rig", [status]))

    def report(self, level: Level, message: str) -> None:
        """Publish how the solver fares."""
        status = Status("Solver", level, message)
        stamp = Time(nanoseconds=self._stamp)
        self._diagnostics.publish(diagnostics_message(stamp, "predictor", "rig", [status]))


def test_monitor_alone_prints_what_comes_and_sums_up_when_it_is_ended(graph, start_node):
    process = start_node("monitor", "--ros-args", "-r", "__ns:=/played")
    predictor = PlayedPredictor(graph, "/played")

    def until_said(text: str, between: Callable[[], None]) -> None:
        graph.until(lambda: text in process.said(), f"monitor prints {text!r}", between)

    until_said("3000  a            0.5000      0.2500", lambda: predictor.predict(0.5))
    assert "   2.00         -       -       -" in process.said()
    until_said("ignored on predictor/eccentricity", predictor.publish_nonsense)
    until_said("nan      0.2500", lambda: predictor.predict(math.nan))
    until_said("Solver ERROR: no balance", lambda: predictor.report(Level.ERROR, "no balance"))
    until_said("Solver OK: balance", lambda: predictor.report(Level.OK, "balance"))
    until_said("=> WARN: Jump expected at 4", lambda: predictor.warn(Level.WARN, 4001.0))
    until_said("    4001     0.0\n", lambda: predictor.predict(0.5))
    predictor.warn(Level.WARN, 4001.5)
    until_said("=> ERROR: Jump expected at 4", lambda: predictor.warn(Level.ERROR, 4002.5))
    assert process.said().count("=> WARN") == 1
    assert process.stop(signal.SIGINT) == 0
    lines = process.said().splitlines()
    assert sum("predictor: Solver" in line for line in lines) == 2
    assert re.fullmatch(r"\d+ speeds, \d+ predictions, [1-9]\d* of them without a.*", lines[-1])
    assert "Traceback" not in process.said()
