"""The predictor after an end that it could not foresee, and its worker process after one."""

import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from benchmarks.usage import usage

from .graph import Graph, Remote, strings  # first of these, as it skips the file without ROS

# isort: split
from .process import PAPER_ROTOR, NodeProcess
from .victim import Victim

OK, WARN = b"\x00", b"\x01"
FIRST_PREDICTION = 3.0  # s on an idle computer
LOADED = 2.0  # times the processor time where other processes compete for caches

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
        "unbalance.disk_2.magnitude": 5.039e-4,
    }
    values = (part for key, value in given.items() for part in ("-p", f"{key}:={value}"))
    return start(*values, "-r", f"__node:={name}")


@pytest.mark.parametrize(("branch", "kill"), [("lower", "starting"), ("upper", "writing")])
def test_branch_and_alarm_outlive_sigkill(graph, start, tmp_path, branch, kill):
    victim = Victim(graph, start, tmp_path, branch, seed=20240607)
    getattr(victim, f"kill_{kill}")()
    victim.revive()
    used = usage(victim.process.pid, 0.0)
    assert used
    assert used.cpu < LOADED * FIRST_PREDICTION
    assert victim.lost() == ""


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
