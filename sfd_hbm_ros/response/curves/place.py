"""Places on the branches of a response curve, read off its arrays, and the responses there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Harmonics, Instability
from sfd_hbm_ros.hbm.corrector import ROUNDING
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import NewtonOptions
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.responses import Response, balanced, between, distance, response_at

if TYPE_CHECKING:
    from sfd_hbm_ros.response.curves.curve import ResponseCurve

Array = NDArray[np.float64]

_NEWTON = NewtonOptions(iterations=12)  # between neighbouring points the start is near


@dataclass(frozen=True, eq=False)
class Place:
    """A place on a branch, at or between two neighbouring points.

    Attributes
    ----------
    branch : CurveBranch
        The branch.
    index : int
        The point before the place in the order of the arc; the next is `index` + 1. A point of the
        branch is the end of the way to it, but a fold has a place on either side.
    value : float
        The parameter: for a speed [rad/s].
    """

    branch: CurveBranch
    index: int
    value: float

    @cached_property
    def part(self) -> float:
        """Part of the way from the point before to the next, from 0 to 1.

        Beside a fold the response goes with the root of the distance in the parameter.
        """
        first, last = self.branch.values[self.index : self.index + 2].tolist()
        part = float(min(max((self.value - first) / (last - first), 0.0), 1.0))
        leaves, meets = self.branch.fold[self.index : self.index + 2].tolist()
        if leaves == meets:
            return part
        return float(np.sqrt(part) if leaves else 1.0 - np.sqrt(1.0 - part))

    @property
    def harmonics(self) -> Harmonics:
        """Harmonics of the branch."""
        return self.branch.solutions[self.index].harmonics

    @cached_property
    def response(self) -> Response:
        """The response about there, from which Newton's method can start."""
        return between(*self._neighbours, self.part)

    @property
    def coefficients(self) -> Array:
        """Coefficients about there [m], (rows, n)."""
        return self.response.coefficients

    @property
    def eccentricity(self) -> float:
        """Greatest eccentricity of any damper about there."""
        here, there = self.branch.worst_eccentricity[self.index : self.index + 2].tolist()
        return float(here + self.part * (there - here))

    @property
    def stable(self) -> bool:
        """Whether the response is stable there.

        Folds and other points at which that changes count as unstable, so that one stable
        neighbour is enough.
        """
        return None in self.branch.instability[self.index : self.index + 2]

    @property
    def stable_orbit(self) -> bool:
        """Whether the response is stable there and periodic."""
        return self.stable and self.branch.periodic

    @property
    def tenable(self) -> bool:
        """Whether a machine can be there: where it is unstable, it must not be as at a fold."""
        kinds = self.branch.instability[self.index : self.index + 2]
        return any(kind is not Instability.FOLD for kind in kinds)

    @property
    def point(self) -> int:
        """The nearer of both points."""
        return self.index + round(self.part)

    @property
    def nearest(self) -> Response:
        """The response at the nearer of both points."""
        return self.branch.solutions[self.point]

    def is_at(self, other: Place) -> bool:
        """Whether this is another place's stretch between two points."""
        return self.branch is other.branch and self.index == other.index

    def distance(self, response: Response) -> float:
        """Greatest difference of any coefficient from a response's, in clearances."""
        return distance(self.response, response)

    @property
    def _neighbours(self) -> tuple[Response, Response]:
        return self.branch.solutions[self.index], self.branch.solutions[self.index + 1]


def place_on(branch: CurveBranch, index: int, value: float) -> Place:
    """The place of a value of the parameter after one point, or that point's own place."""
    if index > 0 and value == branch.values[index] and not branch.fold[index]:
        index -= 1
    return Place(branch, index, value)


def places_at(branches: Sequence[CurveBranch], value: float) -> list[Place]:
    """All places of a value of the parameter, each once."""
    found: list[Place] = []
    for branch in branches:
        before, after = branch.values[:-1] - value, branch.values[1:] - value
        for index in np.flatnonzero((before * after <= 0.0) & (before != after)).tolist():
            place = place_on(branch, index, value)
            if not (found and place.is_at(found[-1])):
                found.append(place)
    return found


def orbit_amid(curve: ResponseCurve, place: Place) -> Place | None:
    """The place itself if its response is periodic, or else that of the circle amid it, if any."""
    if place.branch.periodic:
        return place
    circles = [other for other, _ in curve.meeting(place.branch, 0)]
    amid = places_at(circles, place.value)
    return min(amid, key=lambda one: one.distance(place.response), default=None)


def motion_about(curve: ResponseCurve, orbit: Place) -> Place | None:
    """The stable quasi-periodic place about an unstable circular orbit, if there is one."""
    if orbit.stable:
        return None
    leaving = [
        branch
        for branch in curve.branches
        if not branch.periodic
        and any(other is orbit.branch for other, _ in curve.meeting(branch, 0))
    ]
    about = [place for place in places_at(leaving, orbit.value) if place.stable]
    return min(about, key=lambda one: one.distance(orbit.response), default=None)


def solutions_at(branch: CurveBranch, value: float) -> Iterator[tuple[int, Response]]:
    """Converged responses of a branch at a value of the parameter.

    Yields
    ------
    The index of the point before each in the order of the arc, and the response.
    """
    for place in places_at([branch], value):
        response = response_on(place)
        if response is not None:
            yield place.index, response


def response_on(place: Place) -> Response | None:
    """The response of the curve's own machine at a place, if Newton's method leads there."""
    equations = place.branch.family.at(place.value)
    result = newton(equations, place.response.unknowns, _NEWTON)
    # as near as the branch's own points come
    return response_at(equations, result.x) if balanced(equations, result, ROUNDING) else None
