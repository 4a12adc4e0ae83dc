"""The verb `study` on a Dask cluster of two worker processes, of which one is killed."""

import json
import socket
import subprocess
import sys
import time

import pytest

from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.study import cluster as cluster_module
from sfd_hbm_ros.study.cluster import on_cluster
from sfd_hbm_ros.study.task import Task

from .studies import (
    PAPER,
    ROOT,
    VARIANTS,
    ended,
    kill,
    rows,
    started,
    timeless,
    wait_for_outcomes,
)

pytest.importorskip("distributed", reason="Dask's distributed is not installed")

TASK = Task(read_machine(PAPER), ("dampers.damper_1.viscosity",), 400.0, 401.0, Harmonics(1))


@pytest.fixture
def cluster(tmp_path):
    """Address of a scheduler on this machine, and the processes of its two workers."""
    file = tmp_path / "scheduler.json"
    scheduler = _dask(tmp_path, "scheduler", "--host", "127.0.0.1", "--port", "0")
    options = ("--no-nanny", "--nthreads", "1", "--local-directory", str(tmp_path))
    workers = [_dask(tmp_path, "worker", *options) for _ in range(2)]
    deadline = time.monotonic() + 60.0
    while not file.exists():
        assert scheduler.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.05)
    yield json.loads(file.read_text())["address"], workers
    for process in (*workers, scheduler):
        process.kill()
        process.wait()


def _dask(folder, role, *options):
    """A process of a cluster, whose parts find one another by a file."""
    command = [sys.executable, "-m", f"distributed.cli.dask_{role}", "--no-dashboard"]
    with open(folder / f"{role}.log", "ab") as log:
        return subprocess.Popen(
            [*command, "--scheduler-file", str(folder / "scheduler.json"), *options],
            cwd=ROOT,
            stdout=log,
            stderr=log,
        )


def test_worker_is_killed_and_nothing_is_lost(cluster, tmp_path):
    address, workers = cluster
    output, alone = tmp_path / "cluster.csv", tmp_path / "alone.csv"
    study = started(output, "--scheduler", address)
    wait_for_outcomes(output, 2, study)
    kill(workers[0].pid)
    status, err = ended(study)
    assert status == 0, err
    assert workers[0].wait() == -9
    assert workers[1].poll() is None
    assert ended(started(alone)) == (0, "")
    table = timeless(rows(output))
    assert table == timeless(rows(alone))
    assert len(table) == VARIANTS


def test_no_scheduler_is_status_2_and_one_sentence(tmp_path):
    """Port 9 of this machine, where nobody listens."""
    study = started(tmp_path / "study.csv", "--scheduler", "tcp://127.0.0.1:9")
    status, err = ended(study)
    assert status == 2
    sentence = "sfd_hbm: --scheduler tcp://127.0.0.1:9: no Dask scheduler answers: "
    assert err.startswith(sentence)
    assert err.count("\n") == 1


@pytest.mark.parametrize("address", ["", "foo", "tcp://", "127.0.0.1:port", "no_such://1.2.3.4:5"])
def test_what_is_no_address_is_told_at_once(address):
    with pytest.raises(OSError, match="no Dask scheduler answers: ") as one:
        next(on_cluster(TASK, {0: (0.028,)}, address))
    assert "\n" not in str(one.value)


def test_a_server_that_says_nothing_is_not_waited_for_without_end(monkeypatch):
    """As anything that listens may be, from a printer on."""
    monkeypatch.setattr(cluster_module, "_PATIENCE", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(OSError, match="no Dask scheduler answers: "):
            next(on_cluster(TASK, {0: (0.028,)}, address))
