"""The operating point of a machine, and what is known of it beside the response."""

from collections.abc import Iterator
from typing import NamedTuple

from sfd_hbm_ros.hbm import HarmonicBalance, Solution, solve
from sfd_hbm_ros.response.curves.place import Place
from sfd_hbm_ros.response.tracking.following import holds
from sfd_hbm_ros.response.tracking.guide import Guide

_BESIDE = (0.97, 1.03)  # of a speed, from where a response is followed to it that no guess finds


class OperatingPoint(NamedTuple):
    """A response that a machine is on.

    Attributes
    ----------
    balance : HarmonicBalance
        The machine.
    solution : Solution
        The response.
    place : Place or None
        Where on the curve it is.
    jumped : bool
        Whether the machine jumped to get there.
    stable : bool or None
        Whether it is stable, where the current curve tells.
    orientation : float or None
        Sign of the determinant of the Jacobian, where it is known.
    """

    balance: HarmonicBalance
    solution: Solution
    place: Place | None = None
    jumped: bool = False
    stable: bool | None = None
    orientation: float | None = None


def placed(guide: Guide, solution: Solution, orientation: float | None = None) -> OperatingPoint:
    """A response with its place on the curve."""
    place = guide.match(solution)
    stable = place.stable_orbit if place and guide.current else None
    return OperatingPoint(guide.balance, solution, place, False, stable, orientation)


def begun(guide: Guide, speed: float) -> OperatingPoint:
    """Where a machine of which nothing is known is at a speed [rad/s].

    That is what a run-up through the current curve meets or, without one, what `solve` finds.
    """
    place = guide.run_up(speed).place
    solution = guide.solved(place) if place else None
    if place and solution:
        return OperatingPoint(guide.balance, solution, place, stable=place.stable_orbit)
    return _tenable(guide, iter([solve(guide.balance, speed)]))


def landed(guide: Guide, left: Solution, speed: float) -> OperatingPoint:
    """Where a machine comes that jumps off a response at a speed [rad/s]."""
    return _tenable(guide, _landings(guide, left, speed))._replace(jumped=True)


def _landings(guide: Guide, left: Solution, speed: float) -> Iterator[Solution]:
    """Responses onto which a machine may jump, the likelier first."""
    yield from guide.landings(left, speed)
    yield solve(guide.balance, speed)
    for beside in _BESIDE:
        start = solve(guide.balance, beside * speed)
        if start.converged:
            yield solve(guide.balance, speed, start)


def _tenable(guide: Guide, candidates: Iterator[Solution]) -> OperatingPoint:
    """The first candidate on which a machine can be, or else the first that converged."""
    tried: list[Solution] = []
    for solution in candidates:
        balance = guide.balance_for(solution.harmonics)
        if solution.converged and holds(balance, solution):
            return placed(guide, solution)
        tried.append(solution)
    best = max(tried, key=lambda solution: solution.converged)
    return OperatingPoint(guide.balance, best, stable=False)
