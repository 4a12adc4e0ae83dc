"""Pseudo-arclength continuation of a branch of solutions in one parameter (Eq. 12).

Folds are passed as any other point.
"""

from collections import deque
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.corrector import Corrector
from sfd_hbm_ros.hbm.family import Family
from sfd_hbm_ros.hbm.options import DEFAULTS, ContinuationOptions, NewtonOptions
from sfd_hbm_ros.hbm.points import Point, Stop

Array = NDArray[np.float64]

_CROWDED = 0.99  # eccentricity beyond which a step that fails shows that no room is left
_BEHIND = 2  # points besides the last that say where the next one lies
_RECENT = 100  # steps that have to come further


class Travel:
    """How far a branch has come, and whether that is as far as it may.

    Parameters
    ----------
    options : ContinuationOptions
        The limits: of the number of steps, of the length of the arc and of the progress.
    """

    def __init__(self, options: ContinuationOptions) -> None:
        self._options = options
        self._steps, self._arc = 0, 0.0
        self._recent: deque[float] = deque(maxlen=_RECENT)

    def add(self, length: float) -> Stop | None:
        """Count a step of a length of the arc, 0 for one that failed; return why to end, if so."""
        options = self._options
        self._steps += 1
        self._arc += length
        self._recent.append(length)
        if self._steps >= options.points:
            return Stop.POINTS
        if self._arc > options.arc:
            return Stop.ARC
        crept = len(self._recent) == _RECENT and sum(self._recent) < options.progress
        return Stop.PROGRESS if crept else None


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
        it at either side; its last point lies on that side. The equations are not asked for
        outside.
    options : ContinuationOptions
        Settings.
    newton : NewtonOptions
        Tolerance of the residual.
    direction : (n + 1,) array, optional
        Tangent near which that of the first point is sought, by default that towards `end`.
    travel : Travel, optional
        How far the branch had come before, where it is taken up again.

    Attributes
    ----------
    corrector : Corrector
        What finds its points.
    stop : Stop or None
        Why it ended.
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
        travel: Travel | None = None,
    ) -> None:
        self.family = family
        self.options = options or ContinuationOptions()
        self.start, self.end = start, end
        self.low, self.high = sorted(bounds or (start, end))
        self.stop: Stop | None = None
        self._x = x
        self._travel = travel or Travel(self.options)
        bounds = self.low, self.high
        self.corrector = Corrector(family, start, bounds, self.options, newton)
        towards_end = np.zeros(self.corrector.scale.size)
        towards_end[-1] = np.sign(end - start)
        self._direction = towards_end if direction is None else direction

    def __iter__(self) -> Iterator[Point]:
        options, corrector = self.options, self.corrector
        point = first = corrector.known(self._x, self.start, self._direction)
        yield point
        behind: list[Point] = []
        step = options.first_step
        while True:
            following = corrector.following(point, step, behind)
            if following is None or not self._smooth(point, following):
                step *= 0.5
                self.stop = self._travel.add(0.0)
                if step < options.shortest_step:
                    self.stop = Stop.CLEARANCE if point.eccentricity > _CROWDED else Stop.STEP
                if self.stop is not None:
                    return
                continue
            if self._passes(point, following, first, step):
                yield first
                self.stop = Stop.CLOSED
                return
            yield following
            if following.value in (self.low, self.high):
                self.stop = Stop.RANGE
                return
            self.stop = self._travel.add(corrector.distance(point, following))
            behind = [point, *behind[: _BEHIND - 1]]
            point = following
            if point.eccentricity > options.eccentricity:
                self.stop = Stop.CLEARANCE
            if self.stop is not None:
                return
            if point.iterations <= 3:
                step = min(1.5 * step, options.longest_step)
            elif point.iterations >= 5:
                step *= 0.7

    def _smooth(self, point: Point, following: Point) -> bool:
        """Whether two points are near enough for a cubic between them to show every fold."""
        turned = np.arccos(np.clip(point.tangent @ following.tangent, -1.0, 1.0))
        if turned > self.options.turning:
            return False
        ahead, after = point.tangent[-1], following.tangent[-1]
        if ahead * after <= 0.0:
            return True  # one fold, which is located afterwards
        # the cubic through both points and slopes has the derivative a + 2 b u + 3 c u^2
        mean = (following.value - point.value) / self.corrector.scale[-1]
        mean /= self.corrector.distance(point, following)
        b, c = 3.0 * mean - 2.0 * ahead - after, ahead + after - 2.0 * mean
        flattest = -b / (3.0 * c) if c != 0.0 else 0.0
        slope = ahead + b * flattest
        return bool(slope * ahead > 0.0 or not 0.0 < flattest < 1.0)

    def _passes(self, point: Point, following: Point, first: Point, step: float) -> bool:
        """Whether the step from a point to the following one runs through the first point."""
        if point is first or first.tangent @ point.tangent < 0.5:
            return False
        scaled, distance = self.corrector.scaled, self.corrector.distance
        ahead = distance(point, first)
        aside = scaled(first) - scaled(point) - ahead * point.tangent
        return bool(
            0.0 < ahead <= distance(point, following)
            and np.linalg.norm(aside) < self.options.turning * step
        )
