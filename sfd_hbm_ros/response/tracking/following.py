"""Following a response without a curve, along the way from one machine and speed to another."""

from dataclasses import replace
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
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.tracking.solved import solved
from sfd_hbm_ros.response.tracking.way import Way
from sfd_hbm_ros.rotor import ResonanceError

Array = NDArray[np.float64]

NEAR = 0.05
"""Distance of two neighbouring responses' coefficients, in clearances, that is no jump."""

STRIDES = 30
"""Largest number of strides on one way, those that fail among them."""

POINTS = 100
"""Largest number of points by arclength on one way."""

_SAFE = 0.8  # part of `NEAR` by which a stride is meant to move the response
_CUT = (0.2, 0.5)  # least and greatest factor from a stride that failed to the next
_GROWTH = (0.5, 3.0)  # the same from one that did not
_SHORTEST = 0.02  # part of the way, below which a stride that fails is not cut
_ARRIVED = 1.0 - 1e-9  # part of the way from which on it is its end
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


class _Step(NamedTuple):
    """A part of a way, the response there as coefficients, and its orientation."""

    part: float
    x: Array
    orientation: float | None


class _Stride(NamedTuple):
    """Where a stride led, how far in clearances, and the orientation there."""

    solution: Solution | None
    moved: float
    orientation: float | None


def follow(way: Way, x: Array, orientation: float | None = None) -> Followed:
    """Follow a response along a way: in strides where it stays near, or else by arclength.

    Mostly a single stride leads to the end. Strides end before a fold; then the rest of the way
    goes by arclength, which shows whether the fold comes before its end.

    Parameters
    ----------
    way : Way
        The way.
    x : (rows n,) array
        Converged coefficients at its start [m].
    orientation : float, optional
        That at its start, where it is known.
    """
    here = _Step(0.0, x, orientation or _orientation(way, x))
    before, stride = here, 1.0
    for _ in range(STRIDES):
        part = here.part + stride if here.part + stride < _ARRIVED else 1.0
        solution, moved, reached = _strode(way, before, here, part)
        if solution and part == 1.0:
            return Followed(solution, 1.0, reached)
        if solution:
            before, here = here, _Step(part, solution.unknowns, reached)
        elif stride < _SHORTEST:
            break
        room = _SAFE * NEAR / moved if moved else np.inf  # where nothing moves, as at no load
        stride *= float(np.clip(room, *(_GROWTH if solution else _CUT)))
    return _by_arclength(way, here)


def holds(balance: HarmonicBalance, solution: Solution) -> bool:
    """Whether a machine can be on a response: every disturbance of the unstable kind grows away.

    Where a response loses stability otherwise, the machine goes on about it.
    """
    return stability(balance, solution).instability is not Instability.FOLD


def _strode(way: Way, before: _Step, here: _Step, part: float) -> _Stride:
    """The response at a part of a way, if Newton's method reaches it and it is near."""
    nothing = _Stride(None, np.inf, None)
    try:
        equations = way.at(part)
    except ResonanceError:
        return nothing
    onward = here.x
    if here.part > before.part:
        onward = here.x + (here.x - before.x) * (part - here.part) / (here.part - before.part)
    if equations.eccentricity(onward) >= 1.0:
        return nothing
    solution = solved(equations, onward, _NEWTON)
    if solution is None:
        return nothing
    moved = float(np.abs((solution.unknowns - here.x) / equations.scale).max())
    if moved > NEAR:
        return _Stride(None, moved, None)
    reached = _sign(equations, solution.unknowns)
    # beyond a fold lies the unstable part; the sign also changes at resonances of the held rotor
    if reached != here.orientation and not holds(equations.balance, solution):
        return nothing
    return _Stride(solution, moved, reached)


def _by_arclength(way: Way, start: _Step) -> Followed:
    """The response at the end of a way, or where its branch turns back or ends before."""
    last: Point | None = None
    try:
        branch = Branch(way, start.x, start.part, 1.0, options=_ARC)
        for point in branch:
            if point.tangent[-1] <= 0.0:
                end = _last_before_fold(branch, last, point) if last else None
                return Followed(_solution(way, end), 1.0, None) if end else _end(way, last, start)
            last = point
    except ResonanceError:
        pass
    return _end(way, last, start)


def _end(way: Way, last: Point | None, start: _Step) -> Followed:
    """Where a branch ends, after its last point if there is any."""
    if last is None:
        return Followed(None, start.part, None)
    return Followed(_solution(way, last), last.value, None)


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
    solution = solution_at(equations.balance, equations.speed, point.x)
    residual = float(np.linalg.norm(equations.residual(point.x))) / (equations.load or 1.0)
    return replace(solution, residuals=(residual,))


def _orientation(way: Way, x: Array) -> float | None:
    try:
        return _sign(way.at(0.0), x)
    except ResonanceError:
        return None


def _sign(equations: Equations, x: Array) -> float:
    """Sign of the determinant of the Jacobian."""
    _, jacobian = equations.linearise(x)
    return float(np.linalg.slogdet(jacobian)[0])
