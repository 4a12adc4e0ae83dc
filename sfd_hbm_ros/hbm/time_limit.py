"""A limit to the time of a search, for who has to answer whether or not there is a solution.

Newton's method and the continuation look at it before each evaluation of their equations. That is
also when they can be heard to get on with it.
"""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

ELAPSED = 2.5
"""How many times the limit of the processor time may elapse by the clock on the wall."""

_NEVER = math.inf, math.inf
_END = ContextVar("_END", default=_NEVER)  # by the thread's clock, and by the one on the wall
_PROGRESS: ContextVar[Callable[[], None] | None] = ContextVar("_PROGRESS", default=None)


class TimeLimitError(RuntimeError):
    """The time was over before there was a solution.

    Parameters
    ----------
    busy : bool
        Whether it was not the processor time, but that by the clock on the wall.
    """

    def __init__(self, busy: bool) -> None:
        self.busy = busy
        why = ", as the computer was busy" if busy else ""
        super().__init__(f"no solution was found in the time that there was{why}")


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Limit the processor time of what is solved in the block, by this thread.

    It is processor time, as on a busy computer the same search is to come to the same result,
    but where that would take `ELAPSED` times as long it ends, too: who waits has other work.
    Within another limit, the one that is over first counts.

    Parameters
    ----------
    seconds : float
        Processor time [s], infinite for no limit.

    Raises
    ------
    TimeLimitError
        Within the block, when the time is over.
    """
    processor, wall = _END.get()
    end = min(processor, time.thread_time() + seconds)
    token = _END.set((end, min(wall, time.monotonic() + ELAPSED * seconds)))
    try:
        yield
    finally:
        _END.reset(token)


def tell_progress(to: Callable[[], None]) -> None:
    """Have a function called in this thread's context whenever a search gets on."""
    _PROGRESS.set(to)


def check_time_limit() -> None:
    """Raise TimeLimitError if the time is over."""
    tell = _PROGRESS.get()
    if tell is not None:
        tell()
    end = _END.get()
    if end is _NEVER:
        return
    over = time.thread_time() > end[0]
    if over or time.monotonic() > end[1]:
        raise TimeLimitError(busy=not over)
