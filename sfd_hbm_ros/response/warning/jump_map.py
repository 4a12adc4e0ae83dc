"""Where a machine would jump from any place of a response curve, worked out once for the curve.

Every branch is cut into stretches at the points where it turns back or other branches leave it, so
that the speed rises or falls throughout a stretch. A run-up and a coast-down lead from it to its
ends, and on from there where a stable branch leaves or goes on.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import legs, span
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.curves.place import Place, places_at
from sfd_hbm_ros.response.responses import Response
from sfd_hbm_ros.response.warning.outlook import (
    SLIGHT,
    Change,
    JumpAhead,
    Outlook,
    changes,
    unknown_outlook,
)
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Interval = tuple[float, float]

_NARROW = 0.1 * RPM  # rad/s, between a jump and the one back, below which a hysteresis is none


@dataclass(frozen=True)
class Stretch:
    """A part of a branch along which the speed only rises or only falls.

    Attributes
    ----------
    run_up, coast_down : JumpAhead
        The jumps to which it leads.
    stable : tuple of (float, float)
        Ranges of the speed [rad/s] in which it is stable.
    """

    run_up: JumpAhead
    coast_down: JumpAhead
    stable: tuple[Interval, ...]


@dataclass(frozen=True, eq=False)
class JumpMap:
    """The jumps ahead of every place of a response curve over the speed.

    Attributes
    ----------
    stretches : tuple of Stretch
        Those of all branches.
    owner : mapping of CurveBranch to (m - 1,) int array
        For each branch of m points, the number of the stretch to which each step between two of
        them belongs.
    """

    stretches: tuple[Stretch, ...]
    owner: Mapping[CurveBranch, Indices]

    def outlook(self, place: Place, acceleration: float, settled: bool = True) -> Outlook:
        """What lies ahead of a machine; unknown if the place is on another curve.

        Parameters
        ----------
        place : Place
            Where the machine is.
        acceleration : float
            Its angular acceleration [rad/s2]; 0 for a steady speed, NaN if unknown.
        settled : bool, optional
            Whether that tells a time.
        """
        owner, speed = self.owner.get(place.branch), place.value
        if owner is None:
            return unknown_outlook(speed, acceleration)
        here = self.stretches[owner[place.index]]
        bistable = any(
            low <= speed <= high
            for other in self.stretches
            if other is not here
            for low, high in other.stable
        )
        return Outlook(
            speed,
            acceleration,
            bistable,
            here.run_up,
            here.coast_down,
            settled,
            place.eccentricity,
        )

    def outlook_of_any(self, speed: float, acceleration: float, settled: bool = True) -> Outlook:
        """What lies ahead of a machine that may be on any stable response at a speed [rad/s].

        That of the response whose jump is the nearest, with the others beside it; unknown where
        the curve has none.
        """
        places = [place for place in places_at(list(self.owner), speed) if place.stable]
        outlooks = (self.outlook(place, acceleration, settled) for place in places)
        ordered = sorted(outlooks, key=lambda one: one.remoteness)
        if not ordered:
            return unknown_outlook(speed, acceleration)
        return replace(ordered[0], others=tuple(ordered[1:]))


def jump_map(curve: ResponseCurve) -> JumpMap:
    """Work out the jumps from every place of a response curve over the speed.

    Detached branches count where they are among the curve's branches.
    """
    stretches: list[Stretch] = []
    owner = {}
    for branch in curve.branches:
        order = _arc(branch)
        forks = [at for at in range(len(order)) if curve.meeting(branch, int(order[at]))]
        bounds = sorted({0, *_turns(branch.values[order]), *forks, len(order) - 1})
        owner[branch] = np.empty(len(order) - 1, np.intp)
        for first, last in pairwise(bounds):
            points = order[first : last + 1]
            steps = points[:-1] % len(owner[branch])
            owner[branch][steps] = len(stretches)
            stretches.append(_stretch(curve, branch, points, steps))
    return JumpMap(tuple(stretches), owner)


def _arc(branch: CurveBranch) -> Indices:
    """Indices of a branch's points along its arc; a closed one is entered where it turns."""
    order = np.arange(len(branch.values))
    if branch.stop is not Stop.CLOSED:
        return order
    turn = _turns(branch.values)[0]
    return np.concatenate([order[turn:], order[1 : turn + 1]])


def _turns(values: Array) -> list[int]:
    """Indices at which a sequence of values begins to fall or to rise."""
    rising = np.diff(values) > 0.0
    turns: list[int] = (np.flatnonzero(rising[1:] != rising[:-1]) + 1).tolist()
    return turns


def _stretch(
    curve: ResponseCurve, branch: CurveBranch, points: Indices, steps: Indices
) -> Stretch:
    """The stretch through points of a branch and the steps between them."""
    if branch.values[points[0]] > branch.values[points[-1]]:
        points, steps = points[::-1], steps[::-1]
    return Stretch(
        _jump(curve, _within(branch, steps[-1]), Direction.RUN_UP),
        _jump(curve, _within(branch, steps[0]), Direction.COAST_DOWN),
        tuple(_stable(branch, points)),
    )


def _within(branch: CurveBranch, step: int) -> Place:
    """The place in the middle of a step between two points."""
    return Place(branch, int(step), float(branch.values[step : step + 2].mean()))


def _jump(curve: ResponseCurve, place: Place, direction: Direction) -> JumpAhead:
    """The first jump on the way from a place; those that nobody would notice are passed over."""
    for end, _, landing in legs(curve, place, direction.end):
        branch, point = end.branch, end.point
        if branch.stop is not Stop.CLOSED and point in (0, len(branch.values) - 1):
            if end.value in span(curve.branches):
                return JumpAhead(direction, math.inf, reach=end.value)
            lost = branch.stop if point > 0 else branch.begin
            if lost not in (Stop.CLEARANCE, Stop.RANGE) or (point > 0 and lost is Stop.RANGE):
                break  # where it was lost
        before = branch.solutions[point]
        after = landing.eccentricity if landing else math.nan
        change = changes(_eccentricities(before), _at(landing) if landing else {})
        if not (landing and _slight(curve, end, landing, change, direction)):
            return JumpAhead(direction, end.value, before.eccentricity_max, after, change)
    return JumpAhead(direction, math.nan)


def _slight(
    curve: ResponseCurve,
    end: Place,
    landing: Place,
    change: tuple[Change, ...],
    direction: Direction,
) -> bool:
    """Whether a jump is too small to be seen, or is undone by next to no change of the speed."""
    if all(abs(one.after - one.before) < SLIGHT for one in change):
        return True
    back = next(legs(curve, landing, -direction.end))
    undone = back.landing is not None and back.landing.branch is end.branch
    return undone and abs(back.end.value - end.value) < _NARROW


def _at(place: Place) -> dict[str, float]:
    """Greatest eccentricity of each damper at a place, by its name."""
    first, last = (
        _eccentricities(place.branch.solutions[index]) for index in (place.index, place.index + 1)
    )
    return {name: one + place.part * (last[name] - one) for name, one in first.items()}


def _eccentricities(response: Response) -> dict[str, float]:
    """Greatest eccentricity of each damper, by its name."""
    return {name: journal.eccentricity_max for name, journal in response.journals.items()}


def _stable(branch: CurveBranch, points: Indices) -> Iterator[Interval]:
    """Ranges of the speed in which a stretch is stable, its points given in rising order.

    The points at which stability changes are themselves unstable, so that between two points it
    is stable where one of them is.
    """
    stable, values = branch.stable[points], branch.values[points]
    holds = np.concatenate([[False], stable[:-1] | stable[1:], [False]])
    for low, high in values[np.flatnonzero(holds[1:] != holds[:-1])].reshape(-1, 2):
        yield float(low), float(high)
