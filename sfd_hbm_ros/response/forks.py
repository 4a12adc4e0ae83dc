"""The branches that leave a response where it loses stability to another periodic one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.hbm.family import MachineFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.hbm.switching import SwitchedBranch, switch
from sfd_hbm_ros.response.judged import CurveBranch, Progress, distance, judged

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


def leaving_branches(
    family: MachineFamily,
    branches: Sequence[CurveBranch],
    bounds: tuple[float, float],
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> tuple[tuple[CurveBranch, ...], tuple[Fork, ...]]:
    """Follow the branches that leave others at period doublings and where a symmetry breaks.

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
    waiting = [place for branch in branches for place in _starts(branch)]
    found: list[CurveBranch] = []
    forks: list[Fork] = []
    while waiting and len(found) < _MOST_BRANCHES:
        start = waiting.pop(0)
        leaving = _leaving(family, start, bounds, options)
        if leaving is None:
            continue
        branch = _shared(judged(leaving, progress), start, 0)
        ends = {0: start}
        end = _joined(branch, waiting)
        if end is not None:
            waiting.remove(end)
            ends[len(branch.values)] = end
            branch = _shared(branch, end, len(branch.values))
        forks += [Fork((other, (branch, at))) for at, other in ends.items()]
        found.append(branch)
        waiting += _starts(branch)
    return tuple(found), tuple(forks)


def _leaving(
    family: MachineFamily,
    place: Place,
    bounds: tuple[float, float],
    options: ContinuationOptions | None,
) -> SwitchedBranch | None:
    branch, i = place
    kind = branch.instability[i]
    assert kind is not None
    value = float(branch.values[i])
    return switch(family, value, branch.solutions[i], _PERIODS[kind], bounds, options)


def _starts(branch: CurveBranch) -> Iterator[Place]:
    """Points at which a branch loses stability to a periodic response that can be followed."""
    for i, kind in branch.onsets:
        if kind in _PERIODS:
            revolutions = _PERIODS[kind] * branch.solutions[i].harmonics.revolutions
            if revolutions <= _MOST_REVOLUTIONS:
                yield branch, i


def _joined(branch: CurveBranch, places: Sequence[Place]) -> Place | None:
    """The place, of some, at which a branch joins the one that it left."""
    if branch.stop is not Stop.JOINED:
        return None
    last = branch.solutions[-1]
    gaps = [distance(last, other.solutions[i]) for other, i in places]
    nearest = int(np.argmin(gaps)) if gaps else 0
    return places[nearest] if gaps and gaps[nearest] < _NEAR else None


def _shared(branch: CurveBranch, place: Place, at: int) -> CurveBranch:
    """A branch with a point of another put in before or behind all of its own.

    The point is as stable as the branch beside it.
    """
    other, i = place
    own, there = branch.solutions[0].harmonics, other.solutions[i]
    value = float(other.values[i])
    x = own.change_from(there.harmonics, there.coefficients).ravel()
    solution = solution_at(branch.family.at(value).balance, there.speed, x)
    kind = branch.instability[min(at, len(branch.values) - 1)]
    return replace(
        branch,
        values=np.insert(branch.values, at, value),
        solutions=(*branch.solutions[:at], solution, *branch.solutions[at:]),
        instability=(*branch.instability[:at], kind, *branch.instability[at:]),
        fold=np.insert(branch.fold, at, False),
    )
