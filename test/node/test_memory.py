"""The predictor after an end that it could not foresee, and its worker process after one."""

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import override, read_machine
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.place import places_at

from .graph import Graph, Remote, strings
from .process import PAPER_ROTOR, NodeProcess

RPM = np.pi / 30.0  # rad/s
OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"
UNBALANCE = "unbalance.disk_2.magnitude", 5.039e-4
BISTABLE = 4100.0 * RPM  # between the jumps at 3985 and 4160 rpm
FIRST_PREDICTION = 3.0  # s on an idle computer
LOADED = 5.0  # times longer where the tests' computer has other work, too

Start = Callable[..., NodeProcess]


def predictor(start: Start, name: str, state_file: Path) -> NodeProcess:
    given = {
        "machine_file": PAPER_ROTOR,
        "state_file": state_file,
        "harmonics": 1,
        "stale_after": 3600.0,
        "speed.min": 350.0,
        "speed.max": 500.0,
        "curve.detached": "false",
        "alarm.margin_warn_rpm": 40.0,
        "alarm.margin_error_rpm": 0.0,
        "alarm.time_warn": 0.0,
        "alarm.time_error": 0.0,
        "alarm.eccentricity_warn": 0.0,
        "alarm.eccentricity_error": 0.0,
        "alarm.latch": "true",
        "alarm.off_delay": 0.0,
        UNBALANCE[0]: UNBALANCE[1],
    }
    values = (part for key, value in given.items() for part in ("-p", f"{key}:={value}"))
    return start(*values, "-r", f"__node:={name}")


@pytest.fixture(scope="module")
def stable() -> list[float]:
    """The eccentricities of the two stable responses, the lower one first."""
    machine = override(read_machine(PAPER_ROTOR), *UNBALANCE)
    curve = response_curve(HarmonicBalance(machine, Harmonics(1)), 350.0, 500.0)
    found = [place.eccentricity for place in places_at(curve.branches, BISTABLE) if place.stable]
    assert len(found) == 2
    return sorted(found)


@pytest.mark.parametrize(("branch", "come_from"), [("upper", 3900.0), ("lower", 4200.0)])
def test_branch_and_alarm_outlive_sigkill(graph, start, tmp_path, stable, branch, come_from):
    file, name = tmp_path / "state.json", f"killed_{branch}"
    process = predictor(start, name, file)
    remote = Remote(graph, f"/{name}")
    remote.meet(come_from * RPM)
    graph.until(lambda: remote.curves, "a curve comes")
    remote.predict(BISTABLE)
    near = 4150.0 * RPM if branch == "upper" else 4000.0 * RPM
    assert remote.until_warning(WARN, "to be acknowledged", near)["branch"] == branch
    assert remote.order("acknowledge") == (True, "acknowledged")
    graph.until(lambda: file.exists(), "a state file comes")
    before = remote.until_warning(WARN, "acknowledged", BISTABLE)
    assert process.stop(signal.SIGKILL) == -signal.SIGKILL

    began = time.monotonic()
    predictor(start, name, file)
    again = Remote(graph, f"/{name}")
    again.meet(BISTABLE)
    assert time.monotonic() - began < LOADED * FIRST_PREDICTION
    eccentricity, _ = again.predict(BISTABLE)
    expected = stable[branch == "upper"]
    assert eccentricity["damper_1/max"] == pytest.approx(expected, abs=0.01)
    after = again.until_warning(WARN, "acknowledged", BISTABLE)
    assert after["occurrences"] == before["occurrences"]
    graph.until(lambda: strings(again.warnings[-1][1])["branch"] == branch, "the branch is known")


def test_refused_state_file_is_reported_and_put_aside(graph, start, tmp_path):
    file = tmp_path / "state.json"
    file.write_text('{"format": "sfd_hbm_ros state", "versi')
    process = predictor(start, "torn", file)
    remote = Remote(graph, "/torn")
    remote.meet(370.0)
    remote.until_status("Model", WARN, f"{file}: refused: torn")
    assert f"{file}: refused: torn" in process.said()
    assert file.with_name("state.json.refused").read_text().startswith('{"format"')
    graph.until(file.exists, "another is written", lambda: remote.send(370.0, remote.now()))


def test_file_that_cannot_be_written_is_reported(graph, start, tmp_path):
    file = tmp_path / "none" / "state.json"
    predictor(start, "unwritable", file)
    remote = Remote(graph, "/unwritable")
    remote.meet(370.0)
    remote.until_status("Model", WARN, f"{file}: cannot be written: No such file or directory")
    file.parent.mkdir()
    steady = lambda: remote.send(370.0, remote.now())  # noqa: E731
    remote.until_status("Model", OK, "active", steady)
    assert file.exists()


def test_predictions_go_on_while_the_worker_process_is_stopped_and_killed(graph, start, tmp_path):
    process = predictor(start, "working", tmp_path / "state.json")
    remote = Remote(graph, "/working")
    remote.meet(370.0)
    graph.until(lambda: remote.curves, "a curve comes")
    graph.until(lambda: model(remote)["worker: process"] != "none", "it has a worker process")
    worker = int(model(remote)["worker: process"])
    os.kill(worker, signal.SIGSTOP)
    number = len(remote.curves)
    assert remote.order("recompute")[0]
    remote.until_status("Model", OK, "is being computed")
    for speed in (371.0, 372.0, 373.0):
        remote.predict(speed)
    assert len(remote.curves) == number
    os.kill(worker, signal.SIGKILL)
    remote.until_status("Model", WARN, "it was killed by SIGKILL")
    remote.predict(374.0)
    graph.until(lambda: len(remote.curves) > number, "a curve comes in spite of it")
    remote.until_status("Model", OK, "active")
    assert model(remote)["worker: replacements"] == "1"
    assert int(model(remote)["worker: process"]) != worker
    assert process.stop(signal.SIGTERM) == 0


def model(remote: Remote) -> dict[str, str]:
    return strings(remote.statuses["Model"])


def test_worker_process_ends_with_the_node(graph: Graph, start, tmp_path):
    process = predictor(start, "ending", tmp_path / "state.json")
    remote = Remote(graph, "/ending")
    remote.meet(370.0)
    worker = int(model(remote)["worker: process"])
    assert process.stop(signal.SIGINT) == 0
    with pytest.raises(ProcessLookupError):
        os.kill(worker, 0)
    assert "Traceback" not in process.said()
