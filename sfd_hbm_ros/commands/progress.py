"""Progress on standard error, where that is a terminal."""

import sys
import time

_INTERVAL = 0.1  # between updates [s]


class Progress:
    """A line that follows a value and is wiped at the end.

    Parameters
    ----------
    template : str
        The line, with ``{}`` for the value.
    """

    def __init__(self, template: str) -> None:
        self._template = template
        self._shown = sys.stderr.isatty()
        self._last = 0.0
        self._points = 0

    def __call__(self, value: float) -> None:
        """Show a value, at most ten times a second."""
        self._points += 1
        now = time.monotonic()
        if self._shown and now - self._last >= _INTERVAL:
            self._last = now
            line = f"{self._points} points, {self._template.format(value)}"
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
