"""The worker process: what it computes, and how it is replaced when it fails. Real processes."""

import os
import pickle
import signal
import sys
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult, compute
from sfd_hbm_ros.node.worker.worker import Patience, Worker

from ...hbm.machines import PAPER, UNBEARABLE, random_machine

QUICK = CurveJob(random_machine(1, elements=4), 1, 100.0, 600.0)
SLOW = CurveJob(random_machine(2, elements=4), 3, 100.0, 600.0)
NOWHERE = CurveJob(override_all(PAPER, UNBEARABLE), 1, 360.0, 470.0)
BROKEN = CurveJob(QUICK.machine, 0, 100.0, 600.0)
NO_PAUSE = Patience(pause=0.01)
LIMIT = 120.0  # s, for a computer that has much else to do


@pytest.fixture
def worker() -> Iterator[Worker]:
    worker = Worker(NO_PAUSE)
    yield worker
    worker.close()


def until(worker: Worker, condition: Callable[[], object]) -> list[CurveResult]:
    """Poll until a condition holds, and return the results that came."""
    results = []
    end = time.monotonic() + LIMIT
    while not condition():
        assert time.monotonic() < end, f"{worker.problem}; {worker.points} points"
        result = worker.poll()
        results += [result] if result else []
        time.sleep(0.01)
    return results


def done(worker: Worker) -> CurveResult:
    """The only result of the worker's job."""
    [result] = until(worker, lambda: worker.job is None)
    assert not worker.failed
    return result


def under_way(worker: Worker, job: CurveJob) -> int:
    """Have a job begun, and return the process that is at it."""
    worker.request(job)
    assert until(worker, lambda: worker.points >= 2) == []
    assert worker.pid is not None
    return worker.pid


def assert_same(result: CurveResult, expected: CurveResult) -> None:
    assert result.job == expected.job
    pairs = zip(result.curve.branches, expected.curve.branches, strict=True)
    for branch, other in pairs:
        np.testing.assert_array_equal(branch.values, other.values)
        for one, another in zip(branch.solutions, other.solutions, strict=True):
            np.testing.assert_array_equal(one.coefficients, another.coefficients)
        assert branch.instability == other.instability
        assert branch.stop is other.stop


@pytest.mark.parametrize("job", [QUICK, SLOW], ids=["without jumps", "with jumps"])
def test_the_result_is_that_of_this_process(worker, job):
    speeds: list[float] = []
    [expected] = compute(job, speeds.append)
    assert any(branch.fold.any() for branch in expected.curve.branches) == (job is SLOW)
    worker.request(job)
    assert_same(done(worker), expected)
    assert worker.points == len(speeds)


def test_a_result_is_small_and_its_eccentricities_are_at_hand(worker):
    worker.request(QUICK)
    [branch] = done(worker).curve.branches
    assert "worst_eccentricity" in vars(branch)
    assert len(pickle.dumps(branch.solutions[1:])) < 100_000 + 1_000 * len(branch.solutions)
    for solution, cached in zip(branch.solutions, branch.worst_eccentricity, strict=True):
        motion = solution.journals["damper_1"]
        orbit = np.linalg.norm(motion.orbit(), axis=1) / motion.clearance
        assert cached == pytest.approx(orbit.max(), abs=1e-9)


def test_the_process_stays_warm(worker):
    worker.request(QUICK)
    done(worker)
    pid = worker.pid
    worker.request(QUICK)
    done(worker)
    assert (worker.pid, worker.replacements, worker.problem) == (pid, 0, "")


def test_a_killed_process_is_replaced_and_its_job_done(worker):
    pid = under_way(worker, SLOW)
    os.kill(pid, signal.SIGKILL)
    [expected] = compute(SLOW, lambda _: None)
    assert_same(done(worker), expected)
    assert worker.pid != pid
    assert worker.replacements == 1
    assert worker.problem == "the worker process failed: it was killed by SIGKILL"


def test_a_stopped_process_is_replaced_and_its_job_done(worker):
    pid = under_way(worker, SLOW)
    os.kill(pid, signal.SIGSTOP)
    worker.patience = Patience(hang=0.5, pause=0.01)
    until(worker, lambda: worker.replacements)
    worker.patience = NO_PAUSE
    assert worker.problem == "the worker process failed: it found no new point for 0.5 s"
    assert state(pid) == ""
    assert done(worker).job == SLOW


def test_a_process_that_dies_idle_is_replaced_before_the_next_job(worker):
    worker.request(QUICK)
    done(worker)
    first = worker.pid
    os.kill(first, signal.SIGKILL)
    until(worker, lambda: worker.pid not in (None, first))
    worker.request(QUICK)
    done(worker)
    assert not worker.failed


def test_a_job_is_given_up_after_so_many_deaths(worker):
    worker.patience = Patience(attempts=2, pause=0.3)
    os.kill(under_way(worker, SLOW), signal.SIGKILL)
    died = time.monotonic()
    until(worker, lambda: worker.failures == 1)
    assert worker.pid is None
    until(worker, lambda: worker.pid)
    assert time.monotonic() - died > 0.3
    os.kill(worker.pid, signal.SIGKILL)
    until(worker, lambda: worker.failures == 2)
    assert (worker.job, worker.failed) == (None, True)
    worker.poll()
    assert worker.pid is None
    worker.request(QUICK)
    assert done(worker).job == QUICK


def test_an_exception_is_told_and_tried_again(worker):
    worker.request(BROKEN)
    until(worker, lambda: worker.job is None)
    assert worker.failed
    assert worker.replacements == NO_PAUSE.attempts
    assert "it raised OptionError: harmonics: 0 is not allowed" in worker.problem


def test_where_there_is_no_solution_no_other_attempt_is_made(worker):
    worker.request(NOWHERE)
    assert until(worker, lambda: worker.job is None) == []
    assert (worker.failed, worker.replacements) == (True, 0)
    assert worker.problem.startswith("no solution at 3437.75 rpm: ")
    worker.request(QUICK)
    done(worker)


def test_the_newest_job_replaces_the_one_that_is_computed(worker):
    pid = under_way(worker, SLOW)
    for _ in range(50):
        worker.request(SLOW)
        worker.poll()
    worker.request(QUICK)
    assert done(worker).job == QUICK
    assert (worker.pid, worker.replacements) == (pid, 0)


def test_a_process_that_is_deaf_to_the_newest_job_is_ended(worker):
    pid = under_way(worker, SLOW)
    os.kill(pid, signal.SIGSTOP)
    worker.request(QUICK)
    assert done(worker).job == QUICK
    assert worker.pid != pid
    assert (worker.replacements, worker.problem) == (0, "")


def test_detached_branches_follow_the_curve(worker):
    machine = random_machine(1, elements=4)
    worker.request(CurveJob(machine, 1, 100.0, 200.0, detached=True))
    first, second = until(worker, lambda: worker.job is None)
    assert (first.complete, first.detached) == (False, None)
    assert second.complete
    assert second.detached is not None
    assert len(second.curve.branches) == len(first.curve.branches)


@pytest.mark.parametrize("stopped", [False, True])
def test_close_ends_the_process(worker, stopped):
    pid = under_way(worker, SLOW)
    if stopped:
        os.kill(pid, signal.SIGSTOP)
    worker.close()
    assert state(pid) == ""
    assert worker.pid is None


def test_a_process_that_cannot_be_started_is_told(worker, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python3")
    worker.request(QUICK)
    until(worker, lambda: worker.failed)
    assert "it cannot be started: [Errno 2] No such file or directory" in worker.problem
    monkeypatch.undo()
    worker.request(QUICK)
    done(worker)


def state(pid: int) -> str:
    """The state of a process: "T" if it is stopped, "Z" if it has ended, empty if it is gone."""
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return ""
