"""The worker process as the node sees it: started, sent to, heard and ended. Without ROS."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from multiprocessing.connection import Pipe
from queue import SimpleQueue
from typing import Any

from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult, Failure

_MODULE = "sfd_hbm_ros.node.worker.process"
_GONE = None  # what the queue holds after the last message

Payload = int | CurveResult | Failure


class Child:
    """A worker process that runs until it is ended, or until this process is gone.

    It is a Python of its own, not a `multiprocessing.Process`: that would import the node's main
    module, and with it rclpy, once more.

    Attributes
    ----------
    pid : int
        Its process id.
    gone : bool
        Whether it has ended by itself.

    Raises
    ------
    OSError
        If it cannot be started.
    """

    def __init__(self) -> None:
        self.gone = False
        self._sent = self._begun = self._ended = 0  # numbers of jobs
        self._sent_at = self._heard_at = time.monotonic()
        self._connection, theirs = Pipe()
        with theirs:
            self._process = _start(theirs.fileno())
        self.pid = self._process.pid
        self._received: SimpleQueue[Any] = SimpleQueue()
        # A thread, as a message can be cut off in its middle, and the node must not wait for it.
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def ready(self) -> bool:
        """Whether it takes a job: not two at a time, so that sending one cannot block."""
        return self._begun == self._sent

    def send(self, number: int, job: CurveJob) -> None:
        """Send it a job, which replaces the last one."""
        self._sent, self._sent_at = number, time.monotonic()
        try:
            self._connection.send((number, job))
        except ConnectionError:
            return  # it is gone, as the reader finds out

    def received(self) -> Iterator[tuple[int, Payload]]:
        """Yield what has come, with the numbers of the jobs."""
        while not self._received.empty():
            message = self._received.get()
            if message is _GONE:
                self.gone = True
                return
            number, payload = message
            self._heard_at = time.monotonic()
            self._begun = number
            if isinstance(payload, Failure) or (
                isinstance(payload, CurveResult) and payload.complete
            ):
                self._ended = number
            yield number, payload

    def silence(self) -> float:
        """Return for how long it has owed an answer and said nothing [s]."""
        if self._ended == self._sent:
            return 0.0
        return time.monotonic() - max(self._heard_at, self._sent_at)

    def delay(self) -> float:
        """Return for how long it has gone on with a job that has been replaced [s]."""
        if self._begun in (self._sent, self._ended):
            return 0.0
        return time.monotonic() - self._sent_at

    def end(self) -> str:
        """End the process for sure, and return how it has ended, in words.

        It has nothing to tidy up, and SIGKILL is what a stopped process heeds, too.
        """
        self._process.kill()
        code = self._process.wait()
        self._reader.join()
        self._connection.close()
        if code < 0:
            return f"it was killed by {signal.Signals(-code).name}"
        return f"it ended with exit code {code}"

    def _read(self) -> None:
        try:
            while True:
                self._received.put(self._connection.recv())
        except Exception:  # its end, or a message that is none
            self._received.put(_GONE)


def _start(descriptor: int) -> subprocess.Popen[bytes]:
    """Start the process with its end of the connection."""
    # As multiprocessing does, so that it finds this package and what that needs.
    path = os.pathsep.join(entry or os.getcwd() for entry in sys.path)
    return subprocess.Popen(
        [sys.executable, "-P", "-m", _MODULE, str(descriptor)],
        stdin=subprocess.DEVNULL,
        env=os.environ | {"PYTHONPATH": path},
        pass_fds=[descriptor],
        # The terminal's Ctrl-C is for the node alone. Should the node go while the process is
        # stopped, the kernel ends it: a group of its own that is stopped and has no parent left.
        process_group=0,
    )
