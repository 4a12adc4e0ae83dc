"""The simulator as a process: the speeds it publishes, its end and its parameters."""

import math
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from scipy.integrate import quad

from .graph import JointState, Parameter, SetParametersAtomically, nanoseconds
from .process import ROOT

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
