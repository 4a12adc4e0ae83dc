"""What an engineer reads off a response curve: folds, jumps, peak, amplification."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.response.curve import ResponseCurve
from sfd_hbm_ros.response.jumps import Direction, Jump, jumps


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
        """Distance between the first jump up through the range and the first one down."""
        first = {jump.direction: jump.value for jump in reversed(self.jumps)}
        if len(first) < 2:
            return None
        return abs(first[Direction.RUN_UP] - first[Direction.COAST_DOWN])

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
