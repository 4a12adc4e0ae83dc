"""Variants computed by processes of this machine."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from typing import Any

from sfd_hbm_ros.kernels import warn_if_uncompiled
from sfd_hbm_ros.study.task import Outcome, Task
from sfd_hbm_ros.threads import one_blas_thread

Variants = Mapping[int, Sequence[float]]


def on_processes(
    task: Task, variants: Variants, processes: int | None = None
) -> Iterator[tuple[int, Outcome]]:
    """Compute variants, and yield each with its number as it is ready.

    Where a process is killed, those at work start anew, one at a time: the variant at which a
    process dies every time, for want of memory perhaps, is left out, and the others go on.

    Parameters
    ----------
    task : Task
        How a variant is computed.
    variants : mapping of int to sequence of float
        The values of each variant by its number.
    processes : int, optional
        Number of processes; as many as there are cores where it is left out.
    """
    warn_if_uncompiled()
    left, count = dict(variants), processes or os.cpu_count() or 1
    alive = True
    while left and alive:
        alive = False
        for number, outcome in _until_broken(task, left, count):
            yield number, outcome
            alive = True
            del left[number]
        for number in list(left)[:count]:  # at one of these a process has died
            for one in _until_broken(task, {number: left.pop(number)}, 1):
                yield one
                alive = True


def _until_broken(task: Task, variants: Variants, processes: int) -> Iterator[tuple[int, Outcome]]:
    """Compute variants until all are done or a process has died."""
    context = multiprocessing.get_context("spawn")  # not forked: other threads may hold locks
    theirs, ours = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(processes, context, _begin, (theirs,))
    with pool, ours, suppress(BrokenProcessPool):  # `ours` closes first: see `_begin`
        numbers: dict[Future[Outcome], int] = {}
        with _interrupts_blocked():
            for number, values in variants.items():
                numbers[pool.submit(task.outcome, values)] = number
        theirs.close()
        for future in as_completed(list(numbers)):
            yield numbers.pop(future), future.result()


def _begin(parent: "Connection[Any, Any]") -> None:
    """Give a worker process one BLAS thread, and end it when the other end of a pipe closes.

    That happens when nobody waits for its work any more, and when the parent has been killed.
    """

    def end() -> None:
        with suppress(EOFError, OSError):
            parent.recv()
        os._exit(0)

    threading.Thread(target=end, daemon=True).start()
    one_blas_thread.__enter__()  # for good


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Leave Ctrl-C to the parent of processes that are started meanwhile."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
