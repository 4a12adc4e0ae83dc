"""Progress on standard error, where that is a terminal."""

import sys
import time
from collections.abc import Callable
from datetime import timedelta

from sfd_hbm_ros.units import RPM

_INTERVAL = 0.1  # between updates [s]
_CELLS = 40

Describe = Callable[[int, float], str]


class Progress:
    """A line that follows a value and is wiped at the end.

    Parameters
    ----------
    describe : callable
        Returns the line for the number of values so far and the last of them.
    """

    def __init__(self, describe: Describe) -> None:
        self._describe = describe
        self._shown = sys.stderr.isatty()
        self._last = 0.0
        self._count = 0

    def __call__(self, value: float) -> None:
        """Take a value, and show it at most ten times a second."""
        self._count += 1
        now = time.monotonic()
        if self._shown and now - self._last >= _INTERVAL:
            self._last = now
            line = self._describe(self._count, value)
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def speed_bar(start: float, end: float) -> Describe:
    """A bar that fills as the speed [rad/s] goes from one end to the other."""

    def describe(_: int, speed: float) -> str:
        part = (speed - start) / (end - start)
        return f"{_bar(part)} {100.0 * part:3.0f} %  {speed / RPM:.0f} rpm"

    return describe


def share_bar(before: int, total: int, things: str) -> Describe:
    """A bar that fills as things are done, some of them before now, with the time left."""
    started = time.monotonic()

    def describe(count: int, _: float) -> str:
        done = before + count
        left = (time.monotonic() - started) / count * (total - done)
        clock = timedelta(seconds=round(left))
        return f"{_bar(done / total)} {done} of {total} {things}, {clock} left"

    return describe


def _bar(part: float) -> str:
    return f"[{'#' * round(part * _CELLS):.<{_CELLS}}]"
