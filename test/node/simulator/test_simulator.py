"""The simulator as a process: the speeds it publishes, its end and its parameters."""

import math
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from scipy.integrate import quad
from std_srvs.srv import Trigger

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, read_machine

from ..graph import JointState, Parameter, SetParametersAtomically, nanoseconds, numbers
from ..process import PAPER_ROTOR, ROOT

RPM = math.pi / 30.0  # rad/s
LIMIT = 30.0  # s
# Up from 2000 to 2100 rpm in 0.2 s, 0.3 s there and back.
FAST = "from_rpm:=2000 to_rpm:=2100.0 rpm_per_second:=500 hold:=0.3 rate:=100"
KNEES, SPEEDS = [0.0, 0.2, 0.5, 0.7], [2000.0 * RPM, 2100.0 * RPM, 2100.0 * RPM, 2000.0 * RPM]


def parameters(text: str) -> list[str]:
    return [argument for value in text.split() for argument in ("-p", value)]


@pytest.fixture
def simulate(start_node):
    """Start a simulator in a namespace."""

    def start(namespace: str, text: str):
        arguments = ["-r", f"__ns:={namespace}", *parameters(text)]
        return start_node("simulator", "--ros-args", *arguments)

    return start


@pytest.fixture(scope="module")
def run(graph, start_node) -> list[JointState]:
    """The messages of a fast run, all of them: it waits for a second subscriber."""
    messages: list[JointState] = []
    topic = "/fast/predictor/speed"
    arguments = ["-r", "__ns:=/fast", *parameters(f"{FAST} subscribers:=2")]
    simulator = start_node("simulator", "--ros-args", *arguments)
    first = graph.node.create_subscription(JointState, topic, messages.append, 100)
    graph.until(first.get_publisher_count, "the first subscriber is ready")
    graph.until(lambda: f"waiting for subscribers on {topic}" in simulator.said(), "it waits")
    assert not messages
    graph.collect(JointState, topic, lambda message: None)
    graph.until(lambda: not simulator.running, "simulator ends by itself")
    assert simulator.wait(0.0) == 0
    assert "Traceback" not in simulator.said()
    return messages


def times(run: list[JointState]) -> np.ndarray:
    """Times [s] since the start of the run, which its last message ends."""
    stamps = np.array([nanoseconds(message.header) for message in run])
    return KNEES[-1] + (stamps - stamps[-1]) * 1e-9


def test_run_is_complete_and_its_stamps_rise(run):
    time = times(run)
    assert np.diff(time).min() > 0.0
    assert time[0] == pytest.approx(0.0, abs=1e-6)
    assert len(run) > 20


def test_speeds_follow_the_profile_at_their_stamps(run):
    assert all(len(message.velocity) == 1 for message in run)
    speeds = [message.velocity[0] for message in run]
    assert speeds == pytest.approx(np.interp(times(run), KNEES, SPEEDS), abs=1e-6)
    assert max(speeds) == pytest.approx(2100.0 * RPM, rel=1e-12)
    assert speeds[-1] == pytest.approx(2000.0 * RPM, rel=1e-12)


def test_position_is_the_integral_of_the_speed(run):
    time = times(run)
    positions = np.array([message.position[0] for message in run])
    assert positions.min() >= 0.0
    assert positions.max() < 2.0 * math.pi
    turned = [
        quad(np.interp, time[0], t, args=(KNEES, SPEEDS), points=KNEES[1:3])[0] for t in time
    ]
    error = positions - positions[0] - turned
    assert np.abs((error + math.pi) % (2.0 * math.pi) - math.pi).max() < 1e-6


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("heard", [True, False])
def test_signals_end_it_cleanly(graph, simulate, number, heard):
    namespace = f"/ended_{number.name}_{heard}"
    simulator = simulate(namespace, "hold:=1000")
    if heard:
        messages: list[JointState] = []
        graph.collect(JointState, f"{namespace}/predictor/speed", messages.append)
        graph.until(lambda: messages, "the run begins")
    else:
        graph.until(lambda: "waiting for subscribers" in simulator.said(), "simulator waits")
    begin = time.monotonic()
    assert simulator.stop(number) == 0
    assert time.monotonic() - begin < 5.0
    assert "Traceback" not in simulator.said()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rate:=0", "rate must be a finite number [Hz] of at least 0.1 and below 10000, not 0"),
        ("to_rpm:=100", "to_rpm must be at least from_rpm, 2000 rpm, not 100"),
        ("from_rpm:=.nan", "from_rpm must be a finite number [rpm] above 0 and below 1e+06, not"),
        ("hold:=[]", "hold must be a finite number [s] of at least 0 and below 1e+06, not"),
        ("subscribers:=1.5", "subscribers must be an integer of at least 0, not 1.5"),
        ("dropout:=1", "dropout must be a finite number of at least 0 and below 1, not 1"),
        ("source:=film", "source must be one of: branch, integration, not 'film'"),
        ("harmonics:=40", "harmonics must be at most 31, not 40"),
        ("machine_file:=none.yaml", "none.yaml"),
        (f"machine_file:={PAPER_ROTOR} gravity:=3", "gravity must be true or false, not 3"),
        (f"machine_file:={PAPER_ROTOR} disks.disk_9.mass:=3", "disks.disk_9"),
        ("use_sim_time:=3", "Trying to set parameter 'use_sim_time' to '3'"),
    ],
)
def test_bad_parameter_ends_it_with_one_sentence(domain, text, sentence):
    command = [sys.executable, "-m", "sfd_hbm_ros.node.simulator", "--ros-args"]
    ended = subprocess.run(
        command + parameters(text), cwd=ROOT, timeout=LIMIT, capture_output=True, text=True
    )
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert ended.stderr.startswith(f"simulator: {sentence}")
    assert ended.stderr.count("\n") == 1


def test_parameters_stay_and_unknown_ones_are_pointed_out(graph, simulate):
    simulator = simulate("/fixed", "form_rpm:=3000")
    service = "/fixed/simulator/set_parameters_atomically"
    change = [Parameter("to_rpm", value=7000.0).to_parameter_msg()]
    request = SetParametersAtomically.Request(parameters=change)
    answer = graph.call(SetParametersAtomically, service, request).result
    assert not answer.successful
    assert "read-only" in answer.reason
    assert "form_rpm is unknown (did you mean from_rpm?)" in simulator.said()
    assert simulator.stop(signal.SIGINT) == 0


@pytest.fixture(scope="module")
def steady(graph, start_node):
    """A jumping machine at 4 100 rpm, its measured orbits by their stamps and its speeds."""
    machine = f"machine_file:={PAPER_ROTOR} unbalance.disk_2.magnitude:=5.039e-4 harmonics:=3"
    run = "from_rpm:=3900 to_rpm:=4100.0 rpm_per_second:=1000 hold:=1000 orbit_rate:=20"
    simulator = start_node(
        "simulator", "--ros-args", "-r", "__ns:=/steady", *parameters(f"{machine} {run}")
    )
    orbits: dict[int, JointState] = {}
    speeds: set[int] = set()
    graph.collect(
        JointState,
        "/steady/predictor/measured",
        lambda message: orbits.update({nanoseconds(message.header): message}),
    )
    graph.collect(
        JointState,
        "/steady/predictor/speed",
        lambda message: speeds.add(nanoseconds(message.header)),
    )
    graph.until(lambda: len(orbits) > 20, "the run-up is over")
    assert orbits.keys() - speeds <= {max(orbits)}, "an orbit has the stamp of a speed"
    yield orbits
    assert simulator.stop(signal.SIGINT) == 0
    assert "Traceback" not in simulator.said()


def amplitude(orbits: dict[int, JointState]) -> float:
    return numbers(orbits[max(orbits)])["damper_1/x/1x/amplitude"]


def test_a_machine_is_measured_and_thrown_onto_its_other_branch(graph, steady):
    """A run-up meets the upper of the two stable responses that `solve` can end on."""
    machine = override(read_machine(PAPER_ROTOR), "unbalance.disk_2.magnitude", 5.039e-4)
    balance = HarmonicBalance(machine, Harmonics(3))
    upper = solve(balance, 3900.0 * RPM)
    for rpm in np.arange(3910.0, 4101.0, 10.0):
        upper = solve(balance, rpm * RPM, upper)
    lower = solve(balance, 4300.0 * RPM)
    for rpm in np.arange(4290.0, 4099.0, -10.0):
        lower = solve(balance, rpm * RPM, lower)
    high, low = (
        math.hypot(journal.cos[1, 0], journal.sin[1, 0])
        for journal in (upper.journals["damper_1"], lower.journals["damper_1"])
    )
    assert high > 2.0 * low
    assert amplitude(steady) == pytest.approx(high, rel=1e-6)
    for expected in (low, high):
        answer = graph.call(Trigger, "/steady/simulator/jump", Trigger.Request())
        assert answer.success
        assert "thrown from eccentricity" in answer.message
        came = len(steady)
        graph.until(lambda came=came: len(steady) > came + 2, "orbits are measured")
        assert amplitude(steady) == pytest.approx(expected, rel=1e-6)


def test_without_a_machine_there_is_no_jump(graph, simulate):
    simulator = simulate("/bare", "gravity:=true")
    answer = graph.call(Trigger, "/bare/simulator/jump", Trigger.Request())
    assert not answer.success
    assert answer.message == "no machine is simulated: machine_file is empty"
    assert "parameter gravity needs a machine_file; it has no effect" in simulator.said()
    assert simulator.stop(signal.SIGINT) == 0


def test_integration_that_lags_behind_says_so(graph, simulate):
    """At 20 000 rpm a revolution lasts 3 ms, less than its integration."""
    run = "from_rpm:=19000 to_rpm:=20000 rpm_per_second:=1e3 hold:=1000 subscribers:=0"
    machine = f"machine_file:={PAPER_ROTOR} harmonics:=1 source:=integration"
    simulator = simulate("/lagging", f"{run} {machine}")
    graph.until(lambda: "the integration cannot keep up" in simulator.said(), "it says so")
    assert simulator.stop(signal.SIGINT) == 0
