"""Memory and processor time of a process and its children, as Linux tells them in /proc."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

_PAGE = os.sysconf("SC_PAGE_SIZE") / 2**20  # MiB
_TICK = 1.0 / os.sysconf("SC_CLK_TCK")  # s


class Usage(NamedTuple):
    """What a process uses at one time.

    Attributes
    ----------
    time : float
        The time [s].
    memory : float
        Resident memory [MiB].
    cpu : float
        Processor time since its start [s].
    """

    time: float
    memory: float
    cpu: float


def usage(pid: int, time: float) -> Usage | None:
    """Return what a process uses, or nothing if it has ended."""
    try:
        process = Path(f"/proc/{pid}")
        pages = int((process / "statm").read_text().split()[1])
        # The name before the last parenthesis may hold anything.
        fields = (process / "stat").read_text().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return None
    return Usage(time, pages * _PAGE, (int(fields[11]) + int(fields[12])) * _TICK)


def children(pid: int) -> list[int]:
    """Return the children of a process, whichever of its threads has started them."""
    lists = [path.read_text() for path in Path(f"/proc/{pid}/task").glob("*/children")]
    return [int(number) for one in lists for number in one.split()]


def growth(samples: list[Usage]) -> float:
    """Return by how much the memory grows [MiB/h], by least squares over the second half."""
    later = np.array([one[:2] for one in samples[len(samples) // 2 :]])
    if len(later) < 2:
        return float("nan")
    return float(np.polyfit(*later.T, 1)[0]) * 3600.0


def load(samples: list[Usage]) -> float:
    """Return the processor time used, as a part of the time."""
    first, last = samples[0], samples[-1]
    return (last.cpu - first.cpu) / (last.time - first.time)
