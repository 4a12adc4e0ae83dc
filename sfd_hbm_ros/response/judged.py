"""A branch with the stability of every point, and the points where that changes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Instability, Solution, stability
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate, with_folds
from sfd_hbm_ros.hbm.family import Family
from sfd_hbm_ros.hbm.points import Point, Stop
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.hbm.switching import breaks_symmetry

Array = NDArray[np.float64]
Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class CurveBranch:
    """One branch of the response, in the order of its arc.

    Attributes
    ----------
    family : Family
        The equations of its points.
    values : (m,) array
        The parameter that varies: rotor speed [rad/s], or an entry of the machine file.
    solutions : tuple of Solution
        The m points.
    instability : tuple of Instability or None
        How each is unstable; None for a stable point, `Instability.FOLD` for a fold. Where a
        symmetry of the response breaks without a fold it is `Instability.SYMMETRY_BREAKING`.
    fold : (m,) boolean array
        Whether each is a fold.
    stop : Stop
        Why the branch ends.
    """

    family: Family
    values: Array
    solutions: tuple[Solution, ...]
    instability: tuple[Instability | None, ...]
    fold: NDArray[np.bool_]
    stop: Stop

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Whether each point is stable, (m,); a fold, where stability changes, is not."""
        return np.array([one is None for one in self.instability])

    @property
    def speed(self) -> Array:
        """Rotor speeds [rad/s], (m,)."""
        return np.array([solution.speed for solution in self.solutions])

    @property
    def onsets(self) -> list[tuple[int, Instability]]:
        """Points at which stability is lost, along the arc or against it, and how; no folds."""
        kinds = (Instability.FOLD, *self.instability, Instability.FOLD)
        return [
            (i, kind)
            for i, kind in enumerate(self.instability)
            if kind not in (None, Instability.FOLD) and None in (kinds[i], kinds[i + 2])
        ]

    def eccentricity(self, damper: str) -> Array:
        """Greatest eccentricity of a damper's orbit, (m,)."""
        return np.array([one.journals[damper].eccentricity_max for one in self.solutions])

    @cached_property
    def worst_eccentricity(self) -> Array:
        """Greatest eccentricity of any damper, (m,)."""
        return np.array([one.eccentricity_max for one in self.solutions])


def distance(one: Solution, other: Solution) -> float:
    """Greatest difference of the coefficients of two responses, of the clearance.

    They may be balanced over different numbers of revolutions.
    """
    if one.harmonics.revolutions < other.harmonics.revolutions:
        one, other = other, one
    shorter = one.harmonics.change_from(other.harmonics, other.coefficients)
    clearances = np.repeat([motion.clearance for motion in one.journals.values()], 2)
    return float(np.abs((one.coefficients - shorter) / clearances).max())


class _Judged(NamedTuple):
    """A point of a branch, its response and how that is unstable."""

    point: Point
    solution: Solution
    instability: Instability | None
    fold: bool


def judged(branch: Branch, progress: Progress | None = None) -> CurveBranch:
    """Follow a branch to its end, with its folds and the stability of every point.

    Where stability is lost or regained other than at a fold, the point of the change is put in.
    """
    points: list[_Judged] = []
    for point, fold in with_folds(branch, _reported(branch, progress)):
        one = _judge(branch.family, point, fold)
        if points and not fold and not points[-1].fold:
            change = _change(branch, points[-1], one)
            points += [change] if change else []
        points.append(one)
    assert branch.stop is not None
    return CurveBranch(
        branch.family,
        np.array([one.point.value for one in points]),
        tuple(one.solution for one in points),
        tuple(one.instability for one in points),
        np.array([one.fold for one in points]),
        branch.stop,
    )


def _judge(family: Family, point: Point, fold: bool) -> _Judged:
    at = family.at(point.value)
    solution = solution_at(at.balance, at.speed, point.x)
    kind = Instability.FOLD if fold else stability(at.balance, solution).instability
    return _Judged(point, solution, kind, fold)


def _change(branch: Branch, before: _Judged, after: _Judged) -> _Judged | None:
    """The point between two others at which a multiplier passes the unit circle."""
    if (before.instability is None) == (after.instability is None):
        return None

    def growth(point: Point) -> float:
        at = branch.family.at(point.value)
        found = stability(at.balance, solution_at(at.balance, at.speed, point.x))
        return found.growth

    point = locate(branch, before.point, after.point, growth)
    if point is None:
        return None
    kind = before.instability or after.instability
    if kind is Instability.FOLD and breaks_symmetry(branch.family.at(point.value), point.x):
        kind = Instability.SYMMETRY_BREAKING
    return _judge(branch.family, point, False)._replace(instability=kind)


def _reported(branch: Branch, progress: Progress | None) -> Iterator[Point]:
    for point in branch:
        if progress is not None:
            progress(point.value)
        yield point
