"""What an engineer reads off a response curve: folds, jumps, peak, amplification."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import Leg, legs
from sfd_hbm_ros.response.curves.jumps import Direction, Jump, jumps, leaps


@dataclass(frozen=True)
class Mark:
    """A point of a curve: the parameter and the greatest eccentricity of any damper there."""

    value: float
    eccentricity: float


@dataclass(frozen=True, eq=False)
class Summary:
    """Readings of a response curve.

    Attributes
    ----------
    curve : ResponseCurve
        The curve.
    """

    curve: ResponseCurve

    @cached_property
    def folds(self) -> list[Mark]:
        """Where a branch turns back, branch by branch in the order of the arc."""
        return [
            Mark(float(branch.values[i]), float(branch.worst_eccentricity[i]))
            for branch in self.curve.branches
            for i in np.flatnonzero(branch.fold)
        ]

    @cached_property
    def jumps(self) -> list[Jump]:
        """Jumps of a journey up through the range, then of one down."""
        return [jump for direction in Direction for jump in jumps(self.curve, direction)]

    @cached_property
    def instabilities(self) -> list[tuple[Instability, Mark]]:
        """Where a branch loses stability other than at a fold, along its arc or against it."""
        return [
            (kind, Mark(float(branch.values[i]), float(branch.worst_eccentricity[i])))
            for branch in self.curve.branches
            for i, kind in branch.onsets
        ]

    @cached_property
    def peak(self) -> Mark:
        """The stable response of the greatest eccentricity."""
        marks = [
            Mark(float(value), float(eccentricity))
            for branch in self.curve.branches
            for value, eccentricity, stable in zip(
                branch.values, branch.worst_eccentricity, branch.stable, strict=True
            )
            if stable
        ]
        return max(marks, key=lambda mark: mark.eccentricity, default=Mark(np.nan, np.nan))

    @cached_property
    def hysteresis(self) -> float | None:
        """Width of the lowest range that a jump on the way up and one on the way down bound.

        A machine that turned back after either jump would next make the other, so that between
        them there are two stable responses. None where no two jumps belong together so.
        """
        ups, downs = (leaps(self.curve, direction) for direction in Direction)
        widths = (
            up.end.value - down.end.value
            for up in ups
            for down in downs
            if self._comes_next(down, up, Direction.COAST_DOWN)
            and self._comes_next(up, down, Direction.RUN_UP)
        )
        return next(widths, None)

    def _comes_next(self, leap: Leg, before: Leg, direction: Direction) -> bool:
        """Whether a machine that turns after one jump next makes another."""
        assert before.landing is not None
        following = next(legs(self.curve, before.landing, direction.end))
        return following.end.is_at(leap.end)

    @cached_property
    def amplification_factor(self) -> float | None:
        """Peak speed over the width at 1/sqrt(2) of the peak (API 684).

        None where a fold or an end of the range leaves that width undefined.
        """
        if len(self.curve.branches) > 1 or self.folds:
            return None
        [branch] = self.curve.branches
        x, y = branch.values, branch.worst_eccentricity
        top = int(np.argmax(y))
        below = np.flatnonzero(y < y[top] / np.sqrt(2.0))
        left, right = below[below < top], below[below > top]
        if not (left.size and right.size):
            return None
        sides = [
            float(np.interp(y[top] / np.sqrt(2.0), [y[a], y[b]], [x[a], x[b]]))
            for a, b in ((left[-1], left[-1] + 1), (right[0], right[0] - 1))
        ]
        return float(x[top] / abs(sides[1] - sides[0]))
