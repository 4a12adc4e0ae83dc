"""Pseudo-arclength continuation of a branch of solutions in one parameter (Eq. 12).

Unknown are the coefficients and the parameter together. They are scaled, the coefficients by the
clearance and the parameter by its range, so that the length of the arc has no unit and a step is
as wide in eccentricity as in the parameter. Folds are passed as any other point.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

from sfd_hbm_ros.hbm.family import Family, FamilyMember
from sfd_hbm_ros.hbm.hermite import along_branch
from sfd_hbm_ros.hbm.options import DEFAULTS, ContinuationOptions, NewtonOptions
from sfd_hbm_ros.hbm.points import Point, Stop
from sfd_hbm_ros.rotor import ResonanceError

Array = NDArray[np.float64]

ROUNDING = 1e-8
"""Part of the rotor's forces that a residual may be, where by rounding it falls no further."""

_OUTSIDE = 1.0 - 1e-9  # eccentricity at which the film's forces can no longer be resolved
_CROWDED = 0.97  # eccentricity beyond which a step that fails shows that no room is left
_STAGNATION = 0.1  # ratio of successive residuals that shows that only rounding is left
_BEHIND = 2  # points besides the last that say where the next one lies
_NUDGE = 1e-9  # of the parameter's range, by which an exact resonance is stepped over


class Branch:
    """A branch of solutions, followed point by point from a known one.

    Iterating yields the points, the start first; afterwards `stop` says why the branch ended.

    Parameters
    ----------
    family : Family
        The equations.
    x : (n,) array
        Converged coefficients at `start` [m].
    start, end : float
        The parameter at the first point, and where the branch is followed to at first.
    bounds : (2,) tuple of float, optional
        Range of the parameter, by default from `start` to `end`. The branch ends where it leaves
        it at either side; its last point lies on that side.
    options : ContinuationOptions
        Settings.
    newton : NewtonOptions
        Tolerance of the residual.
    direction : (n + 1,) array, optional
        Tangent near which that of the first point is sought, by default that towards `end`.
    """

    def __init__(
        self,
        family: Family,
        x: Array,
        start: float,
        end: float,
        bounds: tuple[float, float] | None = None,
        options: ContinuationOptions | None = None,
        newton: NewtonOptions = DEFAULTS,
        direction: Array | None = None,
    ) -> None:
        self.family = family
        self.options = options or ContinuationOptions()
        self.newton = newton
        self.start, self.end = start, end
        self.low, self.high = sorted(bounds or (start, end))
        self.stop: Stop | None = None
        self._x = x
        self._scale: Array = np.append(family.at(start).scale, self.high - self.low)
        towards_end = np.zeros(self._scale.size)
        towards_end[-1] = np.sign(end - start)
        self._direction = towards_end if direction is None else direction

    def __iter__(self) -> Iterator[Point]:
        options = self.options
        point = first = self._point(self._x, self.start, self._direction, 0)
        yield point
        behind: list[Point] = []
        step = options.first_step
        for _ in range(options.points):
            following = self.corrected(point, step, behind)
            if following is None or not self._smooth(point, following, step):
                step *= 0.5
                if step < options.shortest_step:
                    self.stop = Stop.CLEARANCE if point.eccentricity > _CROWDED else Stop.STEP
                    return
                continue
            if self._passes(point, following, first, step):
                yield first
                self.stop = Stop.CLOSED
                return
            if not self.low <= following.value <= self.high:
                yield self._last(point, following)
                self.stop = Stop.RANGE
                return
            behind = [point, *behind[: _BEHIND - 1]]
            point = following
            yield point
            if point.eccentricity > options.eccentricity:
                self.stop = Stop.CLEARANCE
                return
            if point.iterations <= 3:
                step = min(1.5 * step, options.longest_step)
            elif point.iterations >= 5:
                step *= 0.7
        self.stop = Stop.POINTS

    def distance(self, point: Point, other: Point) -> float:
        """Distance of a point from another along the other's tangent, as `corrected` takes it."""
        return float(point.tangent @ (self._scaled(other) - self._scaled(point)))

    def corrected(self, point: Point, step: float, others: Sequence[Point] = ()) -> Point | None:
        """The point of the branch at a distance `step` along the tangent of another, if any.

        Where other neighbours of that one are given, the nearest first, it is sought along all.
        """
        unknowns, before = along_branch([point, *others], self._scale)(step), np.inf
        distance = point.tangent @ self._scaled(point) + step
        for iteration in range(self.options.iterations + 1):
            value, x = unknowns[-1] * self._scale[-1], unknowns[:-1] * self._scale[:-1]
            equations = self._at(value)
            if equations.eccentricity(x) >= _OUTSIDE:
                return None
            residual, jacobian = equations.linearise(x)
            slope = self.family.slope(equations, value, x)
            matrix = self._bordered(jacobian, slope, point.tangent)
            norm = float(np.linalg.norm(residual))
            if self._balanced(equations, x, norm, before):
                return self._with_tangent(equations, value, x, matrix, iteration)
            constraint = point.tangent @ unknowns - distance
            try:
                unknowns = unknowns - _solved(matrix, np.append(residual, constraint))
            except np.linalg.LinAlgError:
                return None
            before = norm
        return None

    def _balanced(self, equations: FamilyMember, x: Array, norm: float, before: float) -> bool:
        """Whether the forces balance, or as nearly as the rounding of the condensation allows.

        The rounding depends on the parameter, so that Newton's method cannot work it off while
        the parameter moves. It grows near the rotor's undamped poles, as the forces do.
        """
        if norm <= self.newton.tolerance * (equations.load or 1.0):
            return True
        forces = float(np.linalg.norm(equations.rotor_force(x)))
        return norm <= ROUNDING * forces and norm > _STAGNATION * before

    def _point(self, x: Array, value: float, direction: Array, iterations: int) -> Point:
        """A known solution with the tangent that has a positive part along `direction`."""
        equations = self._at(value)
        _, jacobian = equations.linearise(x)
        slope = self.family.slope(equations, value, x)
        matrix = self._bordered(jacobian, slope, direction)
        return self._with_tangent(equations, value, x, matrix, iterations)

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
        matrix[:-1, :-1] = jacobian * self._scale[:-1]
        matrix[:-1, -1] = slope * self._scale[-1]
        matrix[-1] = direction
        return matrix

    def _at(self, value: float) -> FamilyMember:
        try:
            return self.family.at(value)
        except ResonanceError:  # a single value, beside which the branch goes on
            return self.family.at(value + _NUDGE * self._scale[-1])

    def _scaled(self, point: Point) -> Array:
        scaled: Array = np.append(point.x, point.value) / self._scale
        return scaled

    def _smooth(self, point: Point, following: Point, step: float) -> bool:
        """Whether two points are near enough for a cubic between them to show every fold."""
        turned = np.arccos(np.clip(point.tangent @ following.tangent, -1.0, 1.0))
        if turned > self.options.turning:
            return False
        ahead, after = point.tangent[-1], following.tangent[-1]
        if ahead * after <= 0.0:
            return True  # one fold, which is located afterwards
        # the cubic through both points and slopes has the derivative a + 2 b u + 3 c u^2
        mean = (following.value - point.value) / self._scale[-1] / step
        b, c = 3.0 * mean - 2.0 * ahead - after, ahead + after - 2.0 * mean
        flattest = -b / (3.0 * c) if c != 0.0 else 0.0
        slope = ahead + b * flattest
        return bool(slope * ahead > 0.0 or not 0.0 < flattest < 1.0)

    def _passes(self, point: Point, following: Point, first: Point, step: float) -> bool:
        """Whether the step from a point to the following one runs through the first point."""
        if point is first or first.tangent @ point.tangent < 0.5:
            return False
        ahead = self.distance(point, first)
        aside = self._scaled(first) - self._scaled(point) - ahead * point.tangent
        return bool(
            0.0 < ahead <= self.distance(point, following)
            and np.linalg.norm(aside) < self.options.turning * step
        )

    def _last(self, inside: Point, outside: Point) -> Point:
        """The point on the side of the range that the branch leaves."""
        side = self.high if outside.value > self.high else self.low
        part = (side - inside.value) / (outside.value - inside.value)
        x = inside.x + part * (outside.x - inside.x)
        equations = self._at(side)
        for _ in range(self.newton.iterations):
            residual, jacobian = equations.linearise(x)
            if np.linalg.norm(residual) <= self.newton.tolerance * (equations.load or 1.0):
                break
            x = x - np.linalg.solve(jacobian, residual)
        return self._point(x, side, outside.tangent, outside.iterations)


def _solved(matrix: Array, right: Array) -> Array:
    """As `numpy.linalg.solve`, in half the time where the matrix is small."""
    _, _, x, singular = dgesv(matrix, right)
    if singular:
        raise np.linalg.LinAlgError("the bordered matrix is singular")
    solution: Array = x
    return solution
