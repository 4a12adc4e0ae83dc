"""Where a machine would jump from any place of a response curve, worked out once for the curve.

Every branch is cut into stretches at the points where it turns back, so that the speed rises or
falls throughout a stretch and its two ends are where a run-up and a coast-down lead.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curve import ResponseCurve
from sfd_hbm_ros.response.journey import landings
from sfd_hbm_ros.response.judged import CurveBranch
from sfd_hbm_ros.response.jumps import Direction
from sfd_hbm_ros.response.outlook import JumpAhead, Outlook, unknown_outlook
from sfd_hbm_ros.response.place import Place

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Interval = tuple[float, float]


@dataclass(frozen=True)
class Stretch:
    """A part of a branch along which the speed only rises or only falls.

    Attributes
    ----------
    run_up, coast_down : JumpAhead
        What happens at its upper and at its lower end.
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

    def outlook(self, place: Place, acceleration: float) -> Outlook:
        """What lies ahead of a machine; unknown if the place is on another curve.

        Parameters
        ----------
        place : Place
            Where the machine is.
        acceleration : float
            Its angular acceleration [rad/s2]; 0 for a steady speed, NaN if unknown.
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
        return Outlook(speed, acceleration, bistable, here.run_up, here.coast_down)


def jump_map(curve: ResponseCurve) -> JumpMap:
    """Work out the jumps from every place of a response curve over the speed.

    Detached branches count where they are among the curve's branches.
    """
    stretches: list[Stretch] = []
    owner = {}
    for branch in curve.branches:
        order = _arc(branch)
        bounds = [0, *_turns(branch.values[order]), len(order) - 1]
        owner[branch] = np.empty(len(order) - 1, np.intp)
        for first, last in pairwise(bounds):
            stretch = order[first : last + 1]
            owner[branch][stretch[:-1] % len(owner[branch])] = len(stretches)
            stretches.append(_stretch(curve, branch, stretch))
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


def _stretch(curve: ResponseCurve, branch: CurveBranch, points: Indices) -> Stretch:
    """The stretch through points of a branch."""
    if branch.values[points[0]] > branch.values[points[-1]]:
        points = points[::-1]
    lower, upper = int(points[0]), int(points[-1])
    return Stretch(
        _end(curve, branch, upper, Direction.RUN_UP),
        _end(curve, branch, lower, Direction.COAST_DOWN),
        tuple(_stable(branch, points)),
    )


def _end(curve: ResponseCurve, branch: CurveBranch, point: int, direction: Direction) -> JumpAhead:
    """What happens at a point where a stretch ends."""
    value, last = float(branch.values[point]), len(branch.values) - 1
    if branch.stop is not Stop.CLOSED and point in (0, last):
        if value in _range(curve):
            return JumpAhead(direction, math.inf)
        if point == last and branch.stop is not Stop.CLEARANCE:
            return JumpAhead(direction, math.nan)
    left = Place(branch, min(point, last - 1), value)
    after = [place.eccentricity for place in landings(curve.branches, left)[:1]]
    before = float(branch.worst_eccentricity[point])
    return JumpAhead(direction, value, before, *after)


def _range(curve: ResponseCurve) -> Interval:
    """Lowest and highest speed of a curve [rad/s]."""
    lowest = min(float(branch.values.min()) for branch in curve.branches)
    highest = max(float(branch.values.max()) for branch in curve.branches)
    return lowest, highest


def _stable(branch: CurveBranch, points: Indices) -> Iterator[Interval]:
    """Ranges of the speed in which a stretch is stable, its points given in rising order.

    The points at which stability changes are themselves unstable, so that between two points it
    is stable where one of them is.
    """
    stable, values = branch.stable[points], branch.values[points]
    holds = np.concatenate([[False], stable[:-1] | stable[1:], [False]])
    for low, high in values[np.flatnonzero(holds[1:] != holds[:-1])].reshape(-1, 2):
        yield float(low), float(high)
