"""Long work done a slice at a time, between which the executor serves others. Without ROS."""

from __future__ import annotations

import time
from collections.abc import Iterator

PERIOD = 0.01
"""Time from the beginning of one slice to that of the next [s], for a timer."""

SLICE = 0.005
"""Length of a slice [s], but for the step that it ends with: half of the time is for others."""


def advance(work: Iterator[object]) -> bool:
    """Do a slice of some work, and return whether there is more to do.

    Parameters
    ----------
    work : iterator
        Does a short step of the work whenever it is asked for the next item.
    """
    end = time.monotonic() + SLICE
    return any(time.monotonic() >= end for _ in work)
