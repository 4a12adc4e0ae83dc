"""Progress on standard error: a line that moves on a terminal, plain lines elsewhere.

No command is silent for more than a few seconds, whatever it is at.
"""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from datetime import timedelta

from sfd_hbm_ros.units import RPM

_INTERVAL = 0.1  # between updates of a terminal's line [s]
_SILENCE = 3.0  # after which a command says that it is still at work [s]
_CELLS = 40

Describe = Callable[[int, float], str]


class Progress:
    """What a command is at, told on a terminal at once and elsewhere every few seconds.

    Parameters
    ----------
    describe : callable
        Returns a line for the number of values so far and the last of them.
    """

    _present: "Progress | None" = None

    def __init__(self, describe: Describe) -> None:
        self._describe = describe
        self._shown = sys.stderr.isatty()
        self._last = 0.0
        self._count, self._value = 0, 0.0

    def __call__(self, value: float) -> None:
        """Take a value, and show it on a terminal at most ten times a second."""
        self._count, self._value = self._count + 1, value
        now = time.monotonic()
        if self._shown and now - self._last >= _INTERVAL:
            self._last = now
            _write(f"\r\x1b[K{self._line()}")

    def __enter__(self) -> "Progress":
        Progress._present = self
        return self

    def __exit__(self, *_: object) -> None:
        Progress._present = None
        if self._shown:
            _write("\r\x1b[K")

    def _line(self) -> str:
        return self._describe(self._count, self._value)

    @classmethod
    def present(cls) -> str:
        """What the command is at now, empty where it counts nothing."""
        progress = cls._present
        return progress._line() if progress is not None and progress._count else ""


@contextmanager
def at_work(verb: str) -> Iterator[None]:
    """Tell every few seconds that a command is still at work, and at what.

    Parameters
    ----------
    verb : str
        Its name.
    """
    started, done = time.monotonic(), threading.Event()

    def tell() -> None:
        while not done.wait(_SILENCE):
            line = f"{verb}: at work for {time.monotonic() - started:.0f} s"
            at = Progress.present()
            line += f", {at}" if at else ""
            _write(f"\r\x1b[K{line}" if sys.stderr.isatty() else f"{line}\n")

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join()
        if sys.stderr.isatty() and time.monotonic() - started >= _SILENCE:
            _write("\r\x1b[K")


def _write(text: str) -> None:
    with suppress(OSError, ValueError):  # nobody reads it any more
        print(text, end="", file=sys.stderr, flush=True)


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
