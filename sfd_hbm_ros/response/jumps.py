"""The jumps that a machine makes as a parameter rises or falls through a response curve.

The machine stays on its branch until the branch folds back or closes on the clearance. There it
leaves for another stable response at the same value of the parameter. Where its branch loses
stability to one that leaves it, the machine moves onto that one if it is stable and leads onward;
otherwise it jumps there too.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.hbm import Solution, stability
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.curve import ResponseCurve
from sfd_hbm_ros.response.judged import CurveBranch, distance

_MOST_JUMPS = 20  # of one journey, so that a curve with an odd end cannot make it endless
SAME = 1e-5
"""Distance, of the clearance, within which two responses are one."""


class Direction(StrEnum):
    """Which way the parameter goes: for a speed, a run-up or a coast-down."""

    RUN_UP = "run_up"
    COAST_DOWN = "coast_down"


@dataclass(frozen=True, eq=False)
class Jump:
    """One jump.

    Attributes
    ----------
    direction : Direction
        Which way the parameter went.
    value : float
        The parameter: for a speed [rad/s].
    before, after : Solution
        The last response on the branch that is left, and the one on which the machine lands.
    """

    direction: Direction
    value: float
    before: Solution
    after: Solution


class _Place(NamedTuple):
    """A point of a branch, and the step in its arc along which the parameter travels on."""

    branch: CurveBranch
    point: int
    step: int


def jumps(curve: ResponseCurve, direction: Direction) -> list[Jump]:
    """Jumps on the way through the whole range in one direction, in the order they happen."""
    sign = 1.0 if direction is Direction.RUN_UP else -1.0
    place: _Place | None = _first_place(curve, sign)
    found: list[Jump] = []
    while place is not None and len(found) < _MOST_JUMPS:
        place = _travel(curve, place, sign)
        if place is None:
            break
        before = place.branch.solutions[place.point]
        value = float(place.branch.values[place.point])
        landing = _landing(curve, place, value, sign)
        if landing is None:
            break
        after, place = landing
        found.append(Jump(direction, value, before, after))
    return found


def _first_place(curve: ResponseCurve, sign: float) -> _Place:
    """The end of the curve at which the journey begins, a stable one if there is any."""
    ends = [
        _Place(branch, index, step)
        for branch in curve.branches
        for index, step in ((0, 1), (len(branch.values) - 1, -1))
    ]
    return min(
        ends,
        key=lambda end: (sign * end.branch.values[end.point], not end.branch.stable[end.point]),
    )


def _travel(curve: ResponseCurve, place: _Place, sign: float) -> _Place | None:
    """The last point before a stable way on ends; None where the range is left."""
    while (onward := _onward(curve, place, sign)) is not None:
        place = onward
    branch, index, step = place
    turns = 0 <= index + step < len(branch.values) or curve.meeting(branch, index)
    closes = branch.stop is not Stop.RANGE and step > 0
    return place if turns or closes else None


def _onward(curve: ResponseCurve, place: _Place, sign: float) -> _Place | None:
    """The next point in the direction of travel: where branches meet, on the stable one."""
    meeting = curve.meeting(place.branch, place.point)
    here = [(place.branch, place.point), *meeting]
    ways = [_Place(*at, step) for at in here for step in (1, -1)] if meeting else [place]
    for branch, index, step in ways:
        ahead = index + step
        if not 0 <= ahead < len(branch.values):
            continue
        onward = sign * (branch.values[ahead] - branch.values[index]) >= 0.0
        if onward and (branch.stable[ahead] or not meeting):
            return _Place(branch, ahead, step)
    return None


def _landing(
    curve: ResponseCurve, place: _Place, value: float, sign: float
) -> tuple[Solution, _Place] | None:
    """The nearest other stable response at a value, and where on its branch it lies."""
    before = place.branch.solutions[place.point]
    candidates = []
    for branch in curve.branches:
        for i, solution in solutions_at(branch, value):
            if branch is place.branch and abs(i - place.point) <= 1:
                continue
            if distance(solution, before) < SAME or not _stable(branch, value, solution):
                continue
            onward = bool(sign * (branch.values[i + 1] - branch.values[i]) > 0.0)
            there = _Place(branch, i + onward, 1 if onward else -1)
            candidates.append(
                (abs(solution.eccentricity_max - before.eccentricity_max), solution, there)
            )
    if not candidates:
        return None
    _, solution, there = min(candidates, key=lambda candidate: candidate[0])
    return solution, there


def _stable(branch: CurveBranch, value: float, solution: Solution) -> bool:
    return stability(branch.family.at(value).balance, solution).stable


def solutions_at(branch: CurveBranch, value: float) -> Iterator[tuple[int, Solution]]:
    """Converged responses of a branch at a value of the parameter.

    Yields
    ------
    The index of the point before each in the order of the arc, and the response.
    """
    before, after = branch.values[:-1] - value, branch.values[1:] - value
    equations = branch.family.at(value)
    for i in np.flatnonzero((before * after <= 0.0) & (before != after)):
        part = before[i] / (before[i] - after[i])
        here, there = (branch.solutions[j].coefficients for j in (i, i + 1))
        result = newton(equations, (here + part * (there - here)).ravel())
        if result.outcome.converged:
            yield int(i), solution_at(equations.balance, equations.speed, result.x)
