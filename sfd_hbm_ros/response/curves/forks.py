"""The branches that leave a response where it loses stability to another one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.hbm import Instability, Solution
from sfd_hbm_ros.hbm.family import MachineFamily, SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.oscillation import oscillation
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.quasi_periodic_branch import has_circular_orbits, quasi_periodic_branch
from sfd_hbm_ros.hbm.quasi_periodic_response import QuasiPeriodicResponse, standing_response
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.hbm.switching import SwitchedBranch, switch
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress, judged
from sfd_hbm_ros.response.responses import Response, distance
from sfd_hbm_ros.threads import one_blas_thread

_PERIODS = {Instability.PERIOD_DOUBLING: 2, Instability.SYMMETRY_BREAKING: 1}
_MOST_REVOLUTIONS = 2  # of a period: those of four belong to a cascade that ends in chaos
_MOST_BRANCHES = 8  # that are followed, so that a wild machine's curve ends
_NEAR = 0.2  # of the clearance, from a branch's last point to the one at which it joins another

Place = tuple[CurveBranch, int]


@dataclass(frozen=True, eq=False)
class Fork:
    """A point that two branches share.

    Attributes
    ----------
    sides : (2,) tuple of (CurveBranch, int)
        The branch that loses stability and its point, and the other branch and its end.
    """

    sides: tuple[Place, Place]


class _Start(NamedTuple):
    """A point of a branch at which it loses stability to one that can be followed."""

    branch: CurveBranch
    point: int
    kind: Instability
    solution: Solution

    @property
    def value(self) -> float:
        """The parameter there."""
        return float(self.branch.values[self.point])

    @property
    def place(self) -> Place:
        """The point, as forks have it."""
        return self.branch, self.point


@one_blas_thread
def leaving_branches(
    family: MachineFamily,
    branches: Sequence[CurveBranch],
    bounds: tuple[float, float],
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> tuple[tuple[CurveBranch, ...], tuple[Fork, ...]]:
    """Follow the branches that leave others where a response loses stability.

    That is at period doublings, where a symmetry breaks and, if the orbits are circles and the
    speed varies, at Neimark-Sacker bifurcations.

    Parameters
    ----------
    family : SpeedFamily or ParameterFamily
        The machine as the parameter varies.
    branches : sequence of CurveBranch
        Its known branches.
    bounds : (2,) tuple of float
        Range of the parameter.
    options : ContinuationOptions, optional
        Settings of the continuation.
    progress : callable, optional
        Called with the parameter of every new point.

    Returns
    -------
    The new branches, each with the points that it shares with others at its ends, and these.
    """
    waiting = [start for branch in branches for start in _starts(family, branch)]
    found: list[CurveBranch] = []
    forks: list[Fork] = []
    while waiting and len(found) < _MOST_BRANCHES:
        start = waiting.pop(0)
        leaving = _leaving(family, start, bounds, options)
        if leaving is None:
            continue
        branch = _shared(judged(leaving, progress), start, 0)
        ends = {0: start}
        end = _joined(branch, start.kind, waiting)
        if end is not None:
            waiting.remove(end)
            ends[len(branch.values)] = end
            branch = _shared(branch, end, len(branch.values))
        forks += [Fork((other.place, (branch, at))) for at, other in ends.items()]
        found.append(branch)
        waiting += _starts(family, branch)
    return tuple(found), tuple(forks)


def _leaving(
    family: MachineFamily,
    start: _Start,
    bounds: tuple[float, float],
    options: ContinuationOptions | None,
) -> SwitchedBranch | None:
    if start.kind is Instability.NEIMARK_SACKER:
        return quasi_periodic_branch(family.balance, start.solution, bounds, options=options)
    periods = _PERIODS[start.kind]
    return switch(family, start.value, start.solution, periods, bounds, options)


def _starts(family: MachineFamily, branch: CurveBranch) -> Iterator[_Start]:
    """Points at which a branch loses stability to a response that can be followed."""
    circles = isinstance(family, SpeedFamily) and has_circular_orbits(family.balance)
    for i, kind in branch.onsets:
        solution = branch.solutions[i]
        if not isinstance(solution, Solution):
            continue  # a quasi-periodic response loses stability to ones of three frequencies
        longer = kind in _PERIODS and (
            _PERIODS[kind] * solution.harmonics.revolutions <= _MOST_REVOLUTIONS
        )
        if longer or (kind is Instability.NEIMARK_SACKER and circles):
            yield _Start(branch, i, kind, solution)


def _joined(branch: CurveBranch, kind: Instability, starts: Sequence[_Start]) -> _Start | None:
    """The start, of some, at which a branch that leaves at one kind joins the one it left."""
    if branch.stop is not Stop.JOINED:
        return None
    last = branch.solutions[-1]
    gaps = [(distance(last, one.solution), one) for one in starts if one.kind is kind]
    gap, nearest = min(gaps, key=lambda pair: pair[0], default=(np.inf, None))
    return nearest if gap < _NEAR else None


def _shared(branch: CurveBranch, start: _Start, at: int) -> CurveBranch:
    """A branch with a point of another put in before or behind all of its own.

    The point is as stable as the branch beside it.
    """
    kind = branch.instability[min(at, len(branch.values) - 1)]
    response = _as_on(branch, start)
    return replace(
        branch,
        values=np.insert(branch.values, at, start.value),
        solutions=(*branch.solutions[:at], response, *branch.solutions[at:]),
        instability=(*branch.instability[:at], kind, *branch.instability[at:]),
        fold=np.insert(branch.fold, at, False),
    )


def _as_on(branch: CurveBranch, start: _Start) -> Response:
    """The response at a start as the branch that leaves there has it."""
    beside, there = branch.solutions[0], start.solution
    balance = branch.family.at(start.value).balance
    if isinstance(beside, QuasiPeriodicResponse):
        frequency = oscillation(balance, there).exponent.imag
        return standing_response(there, beside.harmonics, frequency)
    x = beside.harmonics.change_from(there.harmonics, there.coefficients).ravel()
    return solution_at(balance, there.speed, x)
