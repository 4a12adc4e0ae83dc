"""A limit to the time of a search, for who has to answer whether or not there is a solution.

Newton's method and the continuation look at it before each evaluation of their equations.
"""

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_END = ContextVar("_END", default=math.inf)  # by the thread's clock


class TimeLimitError(RuntimeError):
    """The time was over before there was a solution."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Limit the processor time of what is solved in the block, by this thread.

    It is processor time, as on a busy computer the same search is to come to the same result.
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
    token = _END.set(min(_END.get(), time.thread_time() + seconds))
    try:
        yield
    finally:
        _END.reset(token)


def check_time_limit() -> None:
    """Raise TimeLimitError if the time is over."""
    end = _END.get()
    if end < math.inf and time.thread_time() > end:
        raise TimeLimitError("no solution was found in the time that there was")
