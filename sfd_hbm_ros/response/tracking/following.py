"""Following a response without a curve, along the way from one machine and speed to another."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import (
    Equations,
    HarmonicBalance,
    Instability,
    NewtonOptions,
    Solution,
    stability,
)
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.responses import balanced
from sfd_hbm_ros.response.tracking.way import Way
from sfd_hbm_ros.rotor import ResonanceError

Array = NDArray[np.float64]

NEAR = 0.05
"""Distance of two neighbouring responses' coefficients, in clearances, that is no jump."""

POINTS = 100
"""Largest number of points on one way."""

_ARC = ContinuationOptions(first_step=0.05, longest_step=0.2, points=POINTS)
_NEWTON = NewtonOptions(iterations=6, shortest_step=0.1)  # a start that is near needs no more


class Followed(NamedTuple):
    """How far a response was followed.

    Attributes
    ----------
    solution : Solution or None
        The last response of the way, None where not even its start holds.
    part : float
        Where on the way it is: 1 at the end, less where the response ceases to exist or the work
        is used up.
    orientation : float
        Sign of the determinant of the Jacobian there, which changes at every fold.
    """

    solution: Solution | None
    part: float
    orientation: float | None


def follow(way: Way, x: Array, orientation: float | None = None) -> Followed:
    """Follow a response along a way: at one go if it stays near, or else by arclength.

    Parameters
    ----------
    way : Way
        The way.
    x : (rows n,) array
        Converged coefficients at its start [m].
    orientation : float, optional
        That at its start, where it is known.
    """
    at_once = _at_once(way, x, orientation or _orientation(way, x))
    return at_once or _by_arclength(way, x)


def holds(balance: HarmonicBalance, solution: Solution) -> bool:
    """Whether a machine can be on a response: every disturbance of the unstable kind grows away.

    Where a response loses stability otherwise, the machine goes on about it.
    """
    return stability(balance, solution).instability is not Instability.FOLD


def _at_once(way: Way, x: Array, orientation: float | None) -> Followed | None:
    """The response at the end of a way, if Newton's method reaches it and it is near."""
    try:
        equations = way.at(1.0)
    except ResonanceError:
        return None
    if equations.eccentricity(x) >= 1.0:
        return None
    result = newton(equations, x, _NEWTON)
    c = equations.balance.clearances
    moved = float(np.abs((result.x - x).reshape(-1, c.size) / c).max())
    if moved > NEAR or not balanced(equations, result):
        return None
    solution = solution_at(equations.balance, equations.speed, result.x)
    reached = _sign(equations, result.x)
    # beyond a fold lies the unstable part; the sign also changes at resonances of the held rotor
    if reached != orientation and not holds(equations.balance, solution):
        return None
    return Followed(solution, 1.0, reached)


def _by_arclength(way: Way, x: Array) -> Followed:
    """The response at the end of a way, or where its branch turns back or ends before."""
    here = Followed(None, 0.0, None)
    before: Point | None = None
    try:
        branch = Branch(way, x, 0.0, 1.0, options=_ARC)
        for point in branch:
            if point.tangent[-1] <= 0.0:
                end = _last_before_fold(branch, before, point) if before else None
                return Followed(_solution(way, end), 1.0, None) if end else here
            here, before = Followed(_solution(way, point), point.value, None), point
    except ResonanceError:
        pass
    return here


def _last_before_fold(branch: Branch, before: Point, after: Point) -> Point | None:
    """The end of the way if it lies between a point and the fold that follows."""
    slope, back = before.tangent[-1], -after.tangent[-1]
    length = branch.corrector.distance(before, after)
    rise = 0.5 * length * slope**2 / (slope + back)  # if it is a parabola
    if before.value + 1.5 * rise * (branch.high - branch.low) < 1.0:
        return None
    fold = locate(branch, before, after, lambda point: float(point.tangent[-1]))
    if fold is None or fold.value < 1.0:
        return None
    return locate(branch, before, fold, lambda point: point.value - 1.0)


def _solution(way: Way, point: Point) -> Solution:
    equations = way.at(point.value)
    return solution_at(equations.balance, equations.speed, point.x)


def _orientation(way: Way, x: Array) -> float | None:
    try:
        return _sign(way.at(0.0), x)
    except ResonanceError:
        return None


def _sign(equations: Equations, x: Array) -> float:
    """Sign of the determinant of the Jacobian."""
    _, jacobian = equations.linearise(x)
    return float(np.linalg.slogdet(jacobian)[0])
