"""What every comparison has in common: the machine, the tolerance, the clock and the row."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sfd_hbm_ros.hbm import NewtonOptions
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.units import RPM

ROOT = Path(__file__).parents[2]
PAPER = read_machine(ROOT / "config" / "paper_rotor.yaml")
SPEED = 3500.0 * RPM
"""Where steady states are computed [rad/s]: the film is well nonlinear, with an eccentricity of
0.31, and a disturbance dies out by a factor of 0.86 a revolution."""

TOLERANCE = 1e-9
NEWTON = NewtonOptions(tolerance=TOLERANCE)


@dataclass(frozen=True)
class Row:
    """A line of the table.

    Attributes
    ----------
    work, peer : str
        What was computed, and what else computed it.
    ours, theirs : float
        Processor time [s].
    agreement : str
        How far the results agree.
    """

    work: str
    peer: str
    ours: float
    theirs: float
    agreement: str

    def __str__(self) -> str:
        cells = _rounded(self.theirs / self.ours), _duration(self.ours), _duration(self.theirs)
        return f"| {self.work} | {self.peer} | {' | '.join(cells)} | {self.agreement} |"


def _rounded(number: float) -> str:
    """Two digits, which is more than times on a shared machine are good for."""
    return f"{float(f'{number:.2g}'):,g}"


def _duration(elapsed: float) -> str:
    """Seconds, or milliseconds below one."""
    return f"{_rounded(elapsed)} s" if elapsed >= 1.0 else f"{_rounded(1e3 * elapsed)} ms"


def seconds(work: Callable[[], object]) -> float:
    """Processor time of a call [s]."""
    started = time.process_time()
    work()
    return time.process_time() - started


def median_seconds(work: Callable[[], object], repeats: int) -> float:
    """Processor time of a call that has been made before [s], the median of several."""
    work()
    return statistics.median(seconds(work) for _ in range(repeats))
