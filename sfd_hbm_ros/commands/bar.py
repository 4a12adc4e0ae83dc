"""A progress bar on standard error, where that is a terminal."""

import sys
import time

from sfd_hbm_ros.commands.arguments import RPM

_INTERVAL = 0.1  # between updates [s]
_CELLS = 40


class Bar:
    """A bar that fills as the speed goes from one end to the other, and is wiped at the end.

    Parameters
    ----------
    start, end : float
        Speeds [rad/s].
    """

    def __init__(self, start: float, end: float) -> None:
        self._start, self._end = start, end
        self._shown = sys.stderr.isatty()
        self._last = 0.0

    def __call__(self, speed: float) -> None:
        """Show a speed [rad/s], at most ten times a second."""
        now = time.monotonic()
        if not self._shown or now - self._last < _INTERVAL:
            return
        self._last = now
        part = (speed - self._start) / (self._end - self._start)
        cells = "#" * round(part * _CELLS)
        line = f"[{cells:.<{_CELLS}}] {100.0 * part:3.0f} %  {speed / RPM:.0f} rpm"
        print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> "Bar":
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
