"""Response curves computed in a process of their own, which is replaced if it fails. Without ROS.

Nothing here waits: what the process has done meanwhile is collected by polling.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

from sfd_hbm_ros.node.worker.child import Child, Payload
from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult, Failure


@dataclass(frozen=True)
class Patience:
    """How long to wait for the worker process, and how often.

    Parameters
    ----------
    hang : float
        Time without a new point after which the process counts as hung [s].
    replaced : float
        Time that it may go on with a job that has been replaced [s].
    attempts : int
        Attempts at one job.
    pause : float
        Time before the second attempt [s]; it doubles with each further one.
    """

    hang: float = 60.0
    replaced: float = 0.5
    attempts: int = 3
    pause: float = 1.0


class Worker:
    """Computes the newest response curve that is asked for.

    The process is started ahead of the first job and kept for the next one. If it dies or hangs
    it is replaced, and the job tried again.

    Parameters
    ----------
    patience : Patience, optional
        When and how often the process is replaced; it may be changed later.

    Attributes
    ----------
    job : CurveJob or None
        What is being computed; None where that is done or given up.
    points : int
        Points of it so far.
    failures : int
        Failures of the process since the newest job was asked for or done.
    failed : bool
        Whether the newest job was given up.
    problem : str
        What went wrong last, in words; empty if nothing ever did.
    replacements : int
        How often the process was replaced after a failure.
    """

    def __init__(self, patience: Patience | None = None) -> None:
        self.patience = patience or Patience()
        self.job: CurveJob | None = None
        self.points = 0
        self.failures = 0
        self.failed = False
        self.problem = ""
        self.replacements = 0
        self._bug = ""  # traceback of the process's last exception that nobody expected
        self._number = 0  # of the newest job
        self._sent = False  # whether the process has been sent it
        self._start_at = -math.inf
        self._child: Child | None = None

    @property
    def pid(self) -> int | None:
        """Process id of the process; None while there is none."""
        return self._child.pid if self._child else None

    def request(self, job: CurveJob) -> None:
        """Ask for a curve; one asked for before is not wanted any more."""
        self.job = job
        self._number += 1
        self._sent = self.failed = False
        self.points = self.failures = 0
        self._start_at = -math.inf

    def poll(self) -> CurveResult | None:
        """Return a result of the newest job, if one has come since the last call.

        To be called some ten times a second: it also starts, feeds and watches the process.
        """
        if self._child is None:
            self._start()
        if self._child is None:
            return None
        result = self._received(self._child)
        if self._child is not None:
            self._watch(self._child)
        return result

    def taken_bug(self) -> str:
        """Return the traceback of an exception in the process since the last call, if any."""
        bug, self._bug = self._bug, ""
        return bug

    def close(self) -> None:
        """End the process; afterwards, `poll` would start another."""
        self.job = None
        self._end()

    def _start(self) -> None:
        """Start the process, unless it has just failed, or failed too often."""
        if self.failures >= self.patience.attempts or time.monotonic() < self._start_at:
            return
        try:
            self._child = Child()
        except OSError as error:
            self._fail(f"it cannot be started: {error}")

    def _received(self, child: Child) -> CurveResult | None:
        """Take what the process has sent, and return the last result of the newest job."""
        result = None
        for number, payload in child.received():
            if number == self._number:
                result = self._taken(payload) or result
        return result

    def _taken(self, payload: Payload) -> CurveResult | None:
        """Take one answer to the newest job, and return it if it is a result."""
        match payload:
            case CurveResult():
                if payload.complete:
                    self.job, self.failures = None, 0
                return payload
            case Failure(final=True):
                self.job, self.failed, self.problem = None, True, payload.reason
            case Failure():
                self._bug = payload.traceback
                self._fail(payload.reason)
            case int():
                self.points = payload
        return None

    def _watch(self, child: Child) -> None:
        """Send the process the newest job, and replace it where it does not get on with it."""
        if child.gone:
            self._fail("")
        elif child.silence() > self.patience.hang:
            self._fail(f"it found no new point for {self.patience.hang:g} s")
        elif child.delay() > self.patience.replaced:
            self._end()
        elif self.job is not None and not self._sent and child.ready:
            child.send(self._number, self.job)
            self._sent = True

    def _fail(self, reason: str) -> None:
        """Give up the process, and with it the job if it failed too often."""
        ended = self._end()
        self.failures += 1
        self.replacements += 1
        self.problem = f"the worker process failed: {reason or ended}"
        self._start_at = time.monotonic() + self.patience.pause * 2.0 ** (self.failures - 1)
        if self.job is not None and self.failures >= self.patience.attempts:
            self.job, self.failed = None, True

    def _end(self) -> str:
        """End the process, if there is one, and return how it has ended."""
        if self._child is None:
            return ""
        child, self._child, self._sent = self._child, None, False
        return child.end()
