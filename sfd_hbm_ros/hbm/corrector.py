"""Points of a branch, sought beside those that are known (Eq. 12).

Unknown are the coefficients and the parameter together. They are scaled, the coefficients by the
clearance and the parameter by its range, so that the length of the arc has no unit and a step is
as wide in eccentricity as in the parameter.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

from sfd_hbm_ros.hbm.family import Family, FamilyMember
from sfd_hbm_ros.hbm.hermite import along_branch
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import DEFAULTS, ContinuationOptions, NewtonOptions
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.hbm.time_limit import check_time_limit
from sfd_hbm_ros.rotor import ResonanceError
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

ROUNDING = 1e-8
"""Part of the rotor's forces that a residual may be, where by rounding it falls no further."""

_OUTSIDE = 1.0 - 1e-9  # eccentricity at which the film's forces can no longer be resolved
_STAGNATION = 0.1  # ratio of successive residuals that shows that only rounding is left
_BEYOND = 2.0  # steps within which an end of the range may lie
_NUDGE = 1e-9  # of the parameter's range, by which an exact resonance is stepped over


class _Outside(NamedTuple):
    """Coefficients with which the parameter has left its range, and at which end."""

    x: Array
    side: float


class Corrector:
    """Newton's method for points of a branch.

    Parameters
    ----------
    family : Family
        The equations.
    start : float
        A value of the parameter.
    bounds : (2,) tuple of float
        Its range, outside of which the equations are not asked for.
    options : ContinuationOptions
        Settings, of which the number of iterations counts here.
    newton : NewtonOptions
        Tolerance of the residual.

    Attributes
    ----------
    scale : (n + 1,) array
        What the unknowns are compared to.
    """

    def __init__(
        self,
        family: Family,
        start: float,
        bounds: tuple[float, float],
        options: ContinuationOptions | None = None,
        newton: NewtonOptions = DEFAULTS,
    ) -> None:
        self._family, self._newton = family, newton
        self._iterations = (options or ContinuationOptions()).iterations
        self._bounds = bounds
        self.scale: Array = np.append(family.at(start).scale, bounds[1] - bounds[0])

    @one_blas_thread
    def known(self, x: Array, value: float, direction: Array, iterations: int = 0) -> Point:
        """A known solution with the tangent that has a positive part along `direction`."""
        equations = self._at(value)
        _, jacobian = equations.linearise(x)
        slope = self._family.slope(equations, value, x)
        matrix = self._bordered(jacobian, slope, direction)
        try:
            return self._with_tangent(equations, value, x, matrix, iterations)
        except np.linalg.LinAlgError:  # at right angles to the direction, as at a fold
            tangent = np.linalg.svd(matrix[:-1])[2][-1]
            tangent = tangent if tangent @ direction >= 0.0 else -tangent
            return Point(value, x, tangent, equations.eccentricity(x), iterations)

    def scaled(self, point: Point) -> Array:
        """A point's coefficients and parameter by their scale, (n + 1,)."""
        scaled: Array = np.append(point.x, point.value) / self.scale
        return scaled

    def distance(self, point: Point, other: Point) -> float:
        """Distance of a point from another along the other's tangent, as `corrected` takes it."""
        return float(point.tangent @ (self.scaled(other) - self.scaled(point)))

    @one_blas_thread
    def corrected(self, point: Point, step: float, others: Sequence[Point] = ()) -> Point | None:
        """The point of the branch at a distance `step` along the tangent of another, if any.

        Where other neighbours of that one are given, the nearest first, it is sought along all.
        """
        found = self._sought(point, step, others)
        return found if isinstance(found, Point) else None

    @one_blas_thread
    def following(self, point: Point, step: float, others: Sequence[Point] = ()) -> Point | None:
        """As `corrected`, or the point at an end of the range if that comes before, if any."""
        found = self._sought(point, step, others)
        if not isinstance(found, _Outside):
            return found
        end = self._at_value(found.x, found.side, point.tangent)
        # the end must lie ahead, or it belongs to another stretch of the branch
        if end is None or not 0.0 < self.distance(point, end) <= _BEYOND * step:
            return None
        return end

    def _sought(
        self, point: Point, step: float, others: Sequence[Point]
    ) -> "Point | _Outside | None":
        unknowns, before = along_branch([point, *others], self.scale)(step), np.inf
        distance = point.tangent @ self.scaled(point) + step
        low, high = self._bounds
        for iteration in range(self._iterations + 1):
            check_time_limit()
            value, x = unknowns[-1] * self.scale[-1], unknowns[:-1] * self.scale[:-1]
            if not low <= value <= high:
                return _Outside(x, high if value > high else low)
            equations = self._at(value)
            if equations.eccentricity(x) >= _OUTSIDE:
                return None
            residual, jacobian = equations.linearise(x)
            slope = self._family.slope(equations, value, x)
            matrix = self._bordered(jacobian, slope, point.tangent)
            norm = float(np.linalg.norm(residual))
            constraint = point.tangent @ unknowns - distance
            try:
                if self._balanced(equations, x, norm, before):
                    return self._with_tangent(equations, value, x, matrix, iteration)
                unknowns = unknowns - _solved(matrix, np.append(residual, constraint))
            except np.linalg.LinAlgError:
                return None
            before = norm
        return None

    def _at_value(self, x: Array, value: float, direction: Array) -> Point | None:
        """The point at a value of the parameter near coefficients x, if Newton leads there."""
        equations = self._at(value)
        if not equations.eccentricity(x) < _OUTSIDE:
            return None
        result = newton(equations, x, self._newton)
        norm = result.residuals[-1] * (equations.load or 1.0)
        forces = float(np.linalg.norm(equations.rotor_force(result.x)))
        if not (result.outcome.converged or norm <= ROUNDING * forces):
            return None
        return self.known(result.x, value, direction, len(result.residuals) - 1)

    def _balanced(self, equations: FamilyMember, x: Array, norm: float, before: float) -> bool:
        """Whether the forces balance, or as nearly as the rounding of the condensation allows.

        The rounding depends on the parameter, so that Newton's method cannot work it off while
        the parameter moves. It grows near the rotor's undamped poles, as the forces do.
        """
        if norm <= self._newton.tolerance * (equations.load or 1.0):
            return True
        forces = float(np.linalg.norm(equations.rotor_force(x)))
        return norm <= ROUNDING * forces and norm > _STAGNATION * before

    def _with_tangent(
        self, equations: FamilyMember, value: float, x: Array, matrix: Array, iterations: int
    ) -> Point:
        ahead = np.zeros(len(matrix))
        ahead[-1] = 1.0
        tangent = _solved(matrix, ahead)
        tangent /= np.linalg.norm(tangent)
        return Point(value, x, tangent, equations.eccentricity(x), iterations)

    def _bordered(self, jacobian: Array, slope: Array, direction: Array) -> Array:
        """Jacobian of the equations and of the arclength by the scaled unknowns."""
        matrix = np.empty((direction.size, direction.size))
        matrix[:-1, :-1] = jacobian * self.scale[:-1]
        matrix[:-1, -1] = slope * self.scale[-1]
        matrix[-1] = direction
        return matrix

    def _at(self, value: float) -> FamilyMember:
        try:
            return self._family.at(value)
        except ResonanceError:  # a single value, beside which the branch goes on
            beside = value + _NUDGE * self.scale[-1]
            return self._family.at(beside if beside <= self._bounds[1] else 2.0 * value - beside)


def _solved(matrix: Array, right: Array) -> Array:
    """As `numpy.linalg.solve`, in half the time where the matrix is small."""
    _, _, x, singular = dgesv(matrix, right)
    if singular:
        raise np.linalg.LinAlgError("the bordered matrix is singular")
    solution: Array = x
    return solution
