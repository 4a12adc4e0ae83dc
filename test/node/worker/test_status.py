"""What the diagnostics of the model say of the worker process."""

import sys

from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.worker.status import with_worker
from sfd_hbm_ros.node.worker.worker import Patience, Worker
from sfd_hbm_ros.response.warning.settings import Level

from .test_worker import NOWHERE, SLOW, until

MODEL = Status("Model", Level.OK, "active", {"harmonics": "7"})


def test_a_curve_is_computed_and_another_has_no_solution():
    worker = Worker()
    status = with_worker(MODEL, worker)
    assert (status.subject, status.level, status.message) == ("Model", Level.OK, "active")
    assert (status.values["harmonics"], status.values["worker: process"]) == ("7", "none")
    try:
        worker.request(SLOW)
        until(worker, lambda: worker.points >= 2)
        status = with_worker(MODEL, worker)
        told = f"the response curve is being computed, {worker.points} points so far"
        assert (status.level, status.message) == (Level.OK, f"active; {told}")
        assert status.values["worker: process"] == str(worker.pid)
        worker.request(NOWHERE)
        until(worker, lambda: worker.failed)
    finally:
        worker.close()
    status = with_worker(MODEL, worker)
    assert status.level == Level.ERROR
    assert "; there is no new response curve: no solution at 3437.75 rpm: " in status.message


def test_failures_warn_until_the_job_is_given_up(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python3")
    worker = Worker(Patience(attempts=2, pause=0.01))
    worker.request(SLOW)
    until(worker, lambda: worker.failures == 1)
    status = with_worker(MODEL, worker)
    assert status.level == Level.WARN
    assert "; 1 of 2 attempts have failed, the next follows: the worker" in status.message
    assert status.values["worker: replacements"] == "1"
    until(worker, lambda: worker.failed)
    status = with_worker(MODEL, worker)
    assert status.level == Level.ERROR
    assert "it cannot be started: [Errno 2]" in status.values["worker: last problem"]


def test_a_worse_model_stays_as_bad():
    bad = Status("Model", Level.ERROR, "clearance must be positive")
    assert with_worker(bad, Worker()) == Status(
        "Model",
        Level.ERROR,
        "clearance must be positive",
        {"worker: points": "0", "worker: process": "none", "worker: replacements": "0"},
    )
