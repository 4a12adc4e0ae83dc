"""A branch with the stability of every point, and the points where that changes."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Instability, Solution
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate, with_folds
from sfd_hbm_ros.hbm.family import Family
from sfd_hbm_ros.hbm.points import Point, Stop
from sfd_hbm_ros.hbm.quasi_periodic_branch import QuasiPeriodicBranch
from sfd_hbm_ros.hbm.switching import breaks_symmetry
from sfd_hbm_ros.response.responses import Response, response_at, stability_of
from sfd_hbm_ros.threads import one_blas_thread

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
    solutions : tuple of Solution, or of QuasiPeriodicResponse
        The m points, all of one kind.
    instability : tuple of Instability or None
        How each is unstable; None for a stable point, `Instability.FOLD` for a fold. Where a
        symmetry of the response breaks without a fold it is `Instability.SYMMETRY_BREAKING`.
    fold : (m,) boolean array
        Whether each is a fold.
    stop : Stop
        Why the branch ends.
    begin : Stop
        Why it ends at its first point, if it was followed from a point within it both ways.
    """

    family: Family
    values: Array
    solutions: tuple[Response, ...]
    instability: tuple[Instability | None, ...]
    fold: NDArray[np.bool_]
    stop: Stop
    begin: Stop = Stop.RANGE

    @property
    def periodic(self) -> bool:
        """Whether its responses repeat with the speed or after some revolutions."""
        return isinstance(self.solutions[0], Solution)

    @property
    def orbits(self) -> tuple[Solution, ...]:
        """The solutions if they are periodic, or else none."""
        return tuple(one for one in self.solutions if isinstance(one, Solution))

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

    @property
    def reversed(self) -> "CurveBranch":
        """The same branch against its arc."""
        return CurveBranch(
            self.family,
            self.values[::-1],
            self.solutions[::-1],
            self.instability[::-1],
            self.fold[::-1],
            self.begin,
            self.stop,
        )

    def joined_to(self, other: "CurveBranch", first: int = 0) -> "CurveBranch":
        """Join another branch, from its point `first` on, behind the last point of this one."""
        return CurveBranch(
            self.family,
            np.concatenate([self.values, other.values[first:]]),
            self.solutions + other.solutions[first:],
            self.instability + other.instability[first:],
            np.concatenate([self.fold, other.fold[first:]]),
            other.stop,
            self.begin,
        )

    def up_to(self, last: int) -> "CurveBranch":
        """Its part up to a point, that included."""
        part = slice(last + 1)
        return CurveBranch(
            self.family,
            self.values[part],
            self.solutions[part],
            self.instability[part],
            self.fold[part],
            self.stop,
            self.begin,
        )

    def eccentricity(self, damper: str) -> Array:
        """Greatest eccentricity of a damper's orbit, (m,)."""
        return self.eccentricities[damper]

    @cached_property
    def eccentricities(self) -> Mapping[str, Array]:
        """Greatest eccentricity of every damper's orbit, (m,) each, by its name."""
        return {
            name: np.array([one.journals[name].eccentricity_max for one in self.solutions])
            for name in self.solutions[0].journals
        }

    @cached_property
    def worst_eccentricity(self) -> Array:
        """Greatest eccentricity of any damper, (m,)."""
        worst: Array = np.max([*self.eccentricities.values()], axis=0)
        return worst


_STRIDE = 8  # of a quasi-periodic branch, from one point that is judged to the next


class _Judged(NamedTuple):
    """A point of a branch, its response and how that is unstable."""

    point: Point
    solution: Response
    instability: Instability | None
    fold: bool


@one_blas_thread
def judged(branch: Branch, progress: Progress | None = None) -> CurveBranch:
    """Follow a branch to its end, with its folds and the stability of every point.

    Where stability is lost or regained other than at a fold, the point of the change is put in.
    As it takes long to judge a quasi-periodic response, those between two that are judged alike
    are taken to be like them.
    """
    points: list[_Judged] = []
    for one in _judged_points(branch, list(with_folds(branch, _reported(branch, progress)))):
        if points and not one.fold and not points[-1].fold:
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


def _judged_points(branch: Branch, followed: list[tuple[Point, bool]]) -> Iterator[_Judged]:
    """Every point with its stability."""
    stride = _STRIDE if isinstance(branch, QuasiPeriodicBranch) else 1
    last = len(followed) - 1
    marks = [*range(0, last, stride), last]
    known = {mark: _judge(branch.family, *followed[mark]) for mark in marks}
    for begin, end in pairwise(marks):
        yield known[begin]
        kind = known[begin].instability
        folds = any(fold for _, fold in followed[begin : end + 1])
        for point, fold in followed[begin + 1 : end]:
            if folds or known[end].instability is not kind:
                yield _judge(branch.family, point, fold)
            else:
                response = response_at(branch.family.at(point.value), point.x)
                yield _Judged(point, response, kind, False)
    yield known[last]


def _judge(family: Family, point: Point, fold: bool) -> _Judged:
    at = family.at(point.value)
    solution = response_at(at, point.x)
    kind = Instability.FOLD if fold else stability_of(at.balance, solution).instability
    return _Judged(point, solution, kind, fold)


def _change(branch: Branch, before: _Judged, after: _Judged) -> _Judged | None:
    """The point between two others at which a multiplier passes the unit circle."""
    if (before.instability is None) == (after.instability is None):
        return None

    def growth(point: Point) -> float:
        at = branch.family.at(point.value)
        return stability_of(at.balance, response_at(at, point.x)).growth

    point = locate(branch, before.point, after.point, growth)
    if point is None:
        return None
    kind = before.instability or after.instability
    if (
        kind is Instability.FOLD
        and isinstance(before.solution, Solution)
        and breaks_symmetry(branch.family.at(point.value), point.x)
    ):
        kind = Instability.SYMMETRY_BREAKING
    return _judge(branch.family, point, False)._replace(instability=kind)


def _reported(branch: Branch, progress: Progress | None) -> Iterator[Point]:
    for point in branch:
        if progress is not None:
            progress(point.value)
        yield point
