"""What the tracker says at one speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Outcome, Solution
from sfd_hbm_ros.hbm.solution import JournalMotion
from sfd_hbm_ros.response.curves.place import Place


class BranchName(StrEnum):
    """Which of the stable responses at a speed the machine is on."""

    SINGLE = "single"
    """There is no other."""
    UPPER = "upper"
    """Of several, the one of the greatest eccentricity."""
    MIDDLE = "middle"
    """Of three or more, one between."""
    LOWER = "lower"
    """Of several, the one of the least eccentricity."""
    UNKNOWN = "unknown"
    """There is no curve yet, or the history does not tell; then one of them is assumed."""


@dataclass(frozen=True, eq=False)
class Tracked:
    """The operating point at one speed.

    Attributes
    ----------
    solution : Solution
        The response. Unless it converged, its message says why and nothing else is known.
    branch : BranchName
        Which of the stable responses it is.
    jumped : bool
        Whether the machine jumped on the way from the last speed, loads and parameters.
    stable : bool or None
        Whether the response is stable. At a fold a machine jumps; where a response loses its
        stability otherwise it goes on, moving about it, and this is False. So it is about the
        circular orbit amid a quasi-periodic response, on whose branch its place then is. None
        where neither a current curve nor a computation tells.
    place : Place or None
        Where on the curve it is: its branch, and the index of the point before it. On an outdated
        curve, the nearest place.
    current : bool
        Whether the curve is that of the machine with its present parameters and loads.
    other : Solution or None
        The other stable response at this speed, of several the nearest in eccentricity.
    doubtful : bool
        Whether the speed has just leapt away, so that the next one may show that it was wrong.
    wrong_before : bool
        Whether the speed before was measured wrongly, as this one shows.
    bug : Exception or None
        What nobody expected and is why there is no solution: for whoever asks to log.
    """

    solution: Solution
    branch: BranchName = BranchName.UNKNOWN
    jumped: bool = False
    stable: bool | None = None
    place: Place | None = None
    current: bool = False
    other: Solution | None = None
    doubtful: bool = False
    wrong_before: bool = False
    bug: Exception | None = None

    @property
    def verified(self) -> bool:
        """Whether the machine can be there, for all that is known, and the speed is believed."""
        untenable = self.stable is False and self.place is None
        return self.solution.converged and not (self.doubtful or untenable)


def branch_name(solution: Solution, others: Sequence[Place]) -> BranchName:
    """Name of a response beside the other stable ones at its speed."""
    if not others:
        return BranchName.SINGLE
    below = sum(place.eccentricity < solution.eccentricity_max for place in others)
    if below == len(others):
        return BranchName.UPPER
    return BranchName.MIDDLE if below else BranchName.LOWER


def no_solution(balance: HarmonicBalance, speed: float, message: str) -> Solution:
    """A solution that says why there is none."""
    nowhere = np.full((balance.harmonics.rows, 2), np.nan)
    journals = {
        damper.name: JournalMotion(damper.name, damper.clearance, balance.harmonics, nowhere)
        for damper in balance.machine.dampers
    }
    return Solution(speed, balance.harmonics, Outcome.STALLED, message, (), journals)
