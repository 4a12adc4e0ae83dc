"""The worker process: computes response curves for the process that started it. Without ROS.

It is started by `worker.Child` with the number of an inherited socket. It takes numbered jobs and
answers each with its number and a payload: how many points there are so far, from 0 when it
begins, or a result, or a failure. A newer job replaces an older one at its next point.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any, NoReturn

from sfd_hbm_ros.kernels import load_kernels
from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.node.worker.curve_job import CurveJob, Failure, compute
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.threads import one_blas_thread

_NICE = 10  # live predictions come first


class _Replaced(Exception):  # noqa: N818 - no error
    """A newer job has come."""


class _Inbox:
    """The jobs that have arrived; ends the process together with the one that started it."""

    def __init__(self, connection: Connection[Any, Any]) -> None:
        self._connection = connection
        self._jobs: SimpleQueue[tuple[int, CurveJob]] = SimpleQueue()
        threading.Thread(target=self._receive, daemon=True).start()

    def take(self) -> tuple[int, CurveJob]:
        """Wait for a job and return the newest."""
        job = self._jobs.get()
        while not self._jobs.empty():
            job = self._jobs.get()
        return job

    def newer(self) -> bool:
        """Return whether a newer job waits."""
        return not self._jobs.empty()

    def _receive(self) -> None:
        try:
            while True:
                self._jobs.put(self._connection.recv())
        except (EOFError, OSError):
            os._exit(0)  # the other process is gone, and with it the wish for an answer


def serve(connection: Connection[Any, Any]) -> NoReturn:
    """Answer jobs until the other end of the connection is gone."""
    inbox = _Inbox(connection)
    while True:
        number, job = inbox.take()
        with suppress(_Replaced):
            _answer(number, job, connection, inbox)


def _answer(number: int, job: CurveJob, connection: Connection[Any, Any], inbox: _Inbox) -> None:
    points = 0
    connection.send((number, points))

    def progress(_: float) -> None:
        nonlocal points
        points += 1
        connection.send((number, points))
        if inbox.newer():
            raise _Replaced

    try:
        for result in compute(job, progress):
            connection.send((number, result))
            if inbox.newer():
                raise _Replaced
    except (MachineError, NoSolutionError) as error:
        connection.send((number, Failure(str(error), final=True)))
    except _Replaced:
        raise
    except Exception as error:  # what it was is for the other process to tell
        reason = f"it raised {type(error).__name__}: {error}"
        connection.send((number, Failure(reason, False, traceback.format_exc())))


def main() -> None:
    """Serve the connection whose file descriptor is the only argument."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that started it will end it
    os.nice(_NICE)
    load_kernels()
    with one_blas_thread, suppress(ConnectionError):
        serve(Connection(int(sys.argv[1])))


if __name__ == "__main__":
    main()
