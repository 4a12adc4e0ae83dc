"""A response curve as the guide of one machine: where to look for its solutions.

Its solutions are periodic. Where the machine moves quasi-periodically about an unstable circular
orbit, its place is on the quasi-periodic branch, which says what lies ahead, and its solution is
the circle.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, NewtonOptions, Solution
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import Journey, first_place, travel
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.place import Place, motion_about, orbit_amid, places_at
from sfd_hbm_ros.response.tracking.course import Course
from sfd_hbm_ros.response.tracking.following import NEAR
from sfd_hbm_ros.response.tracking.solved import solved

Array = NDArray[np.float64]

_ALIKE = 0.2  # distance from an outdated curve, in clearances, within which it still guides
_KEPT = 16  # places whose coefficients are kept, as they are asked for again
_ROUNDING = 1e-9  # of two distances, in clearances
_NEWTON = NewtonOptions(iterations=8, shortest_step=0.1)  # a start off the curve is near


@dataclass(frozen=True, eq=False)
class Guide:
    """A machine and the curve that guides it, if any.

    Attributes
    ----------
    balance : HarmonicBalance
        The machine with its present parameters and loads.
    curve : ResponseCurve or None
        A curve over the speed, of this machine or of what it was before.
    """

    balance: HarmonicBalance
    curve: ResponseCurve | None = None

    @cached_property
    def current(self) -> bool:
        """Whether the curve is that of the present machine."""
        return self.curve is not None and (
            self.curve.balance.machine == self.balance.machine
            and self.curve.balance.harmonics == self.balance.harmonics
        )

    def balance_for(self, harmonics: Harmonics) -> HarmonicBalance:
        """The machine with the harmonics of a branch that may be sub-harmonic."""
        if harmonics not in self._balances:
            other = HarmonicBalance(self.balance.machine, harmonics, self.balance.model)
            self._balances[harmonics] = other
        return self._balances[harmonics]

    def places(self, speed: float) -> list[Place]:
        """All places of the curve at a speed [rad/s]."""
        if self.curve is None:
            return []
        if speed not in self._places:
            self._places.clear()  # what is asked again is asked at the newest speed
            self._places[speed] = places_at(self.curve.branches, speed)
        return self._places[speed]

    def others(self, speed: float, place: Place | None, eccentricity: float) -> list[Place]:
        """Stable places but one at a speed [rad/s], the nearest to an eccentricity first."""
        others = [
            other
            for other in self.places(speed)
            if other.stable and not (place and other.is_at(place))
        ]
        return sorted(others, key=lambda other: abs(other.eccentricity - eccentricity))

    def run_up(self, speed: float) -> Journey:
        """The journey of a run-up from the beginning of the current curve to a speed [rad/s]."""
        if self.curve is None or not self.current:
            return Journey(None, 0)
        return travel(self.curve, first_place(self.curve.branches), speed)

    def journey(self, place: Place, speed: float) -> Journey:
        """The journey along the current curve from a place to another speed [rad/s]."""
        if self.curve is None or not self.current:
            return Journey(None, 0)
        return travel(self.curve, place, speed)

    def solved(
        self, place: Place, beside: Place | None = None, known: Solution | None = None
    ) -> Solution | None:
        """The machine's periodic response at a place of the curve, if Newton's method leads there.

        At a quasi-periodic place it is the circular orbit about which the machine moves.

        Parameters
        ----------
        place : Place
            The place.
        beside : Place, optional
            Another, at which the response is known. Between the same two points of the curve its
            distance from the curve tells that of the response sought.
        known : Solution, optional
            The response there.
        """
        orbit = self._orbit(place)
        if orbit is None:
            return None
        start = self._coefficients(orbit)
        amid = self._orbit(beside) if beside and known else None
        if known and amid and orbit.is_at(amid):
            start = start + known.coefficients - self._coefficients(amid)
        equations = self.balance_for(orbit.harmonics).at(place.value)
        solution = solved(equations, start.ravel(), _NEWTON)
        if solution is None:
            return None
        own = self._distance(orbit, solution)
        others = [
            self._distance(other, solution) + _ROUNDING
            for other in self.places(place.value)
            if other.branch.periodic and not other.is_at(orbit)
        ]
        return solution if own < min(self._limit, *others, np.inf) else None

    def landings(self, left: Solution, speed: float) -> Iterator[Solution]:
        """Responses near the curve's stable places at a speed [rad/s], the likelier first.

        Parameters
        ----------
        left : Solution
            The response that a machine left.
        speed : float
            Rotor speed [rad/s].
        """
        for place in self.others(speed, None, left.eccentricity_max):
            solution = self.solved(place)
            if solution:
                yield solution

    def match(self, solution: Solution) -> Place | None:
        """The place of a response on the curve, if it lies there and a machine can be on it.

        For an unstable circular orbit it is the stable quasi-periodic one about it, if any.
        """
        places = (
            (self._distance(place, solution), place)
            for place in self.places(solution.speed)
            if place.tenable and place.branch.periodic
        )
        distance, place = min(places, key=lambda one: one[0], default=(np.inf, None))
        if self.curve is None or place is None or distance >= self._limit:
            return None
        return motion_about(self.curve, place) or place

    def _orbit(self, place: Place) -> Place | None:
        """The place itself, or that of the circle amid a quasi-periodic response."""
        return orbit_amid(self.curve, place) if self.curve else place

    def _coefficients(self, place: Place) -> Array:
        """The curve's coefficients at a place of a periodic branch [m], (rows, n)."""
        if place not in self._starts:
            if len(self._starts) >= _KEPT:
                self._starts.clear()
            course = self._courses.setdefault(place.branch, Course(place.branch))
            self._starts[place] = course.coefficients(place)
        return self._starts[place]

    def _distance(self, place: Place, solution: Solution) -> float:
        """Distance of a periodic place from a response, in clearances."""
        if place.harmonics != solution.harmonics:
            return place.distance(solution)
        apart = self._coefficients(place) - solution.coefficients
        return float(np.abs(apart / self.balance.clearances).max())

    @property
    def _limit(self) -> float:
        return NEAR if self.current else _ALIKE

    @cached_property
    def _places(self) -> dict[float, list[Place]]:
        return {}

    @cached_property
    def _starts(self) -> dict[Place, Array]:
        return {}

    @cached_property
    def _courses(self) -> dict[CurveBranch, Course]:
        return {}

    @cached_property
    def _balances(self) -> dict[Harmonics, HarmonicBalance]:
        return {self.balance.harmonics: self.balance}
