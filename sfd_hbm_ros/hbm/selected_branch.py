"""Continuation in the speed with the harmonics that matter at each point."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.continuation import Branch, Travel
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.hbm.selection import Neglect, SelectedBalance

Array = NDArray[np.float64]
Group = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class SelectedPoint:
    """A point of a branch with the harmonics in use there.

    Attributes
    ----------
    point : Point
        The point, whose coefficients are those of the group.
    group : tuple of int
        Harmonics in use, as multiples of the trial group.
    neglect : Neglect
        What they leave out, against the trial group.
    """

    point: Point
    group: Group
    neglect: Neglect


class SelectedBranch(Branch):
    """A branch over the speed, followed in the harmonics that matter.

    Every point lies within the tolerance of the trial group's solution, by the estimate of
    `SelectedBalance.neglect`. A group that is too small at a point is enlarged, and the step taken
    again; one that is too large shrinks for the following steps.

    Iterating yields the points in the trial group's coefficients, those out of use exactly zero;
    events between them are located with the whole group.

    Parameters
    ----------
    balance : SelectedBalance
        The machine, its trial group and the tolerance.
    start, end : float
        Speeds from which and to which the branch is followed [rad/s].
    options : ContinuationOptions, optional
        Settings.

    Raises
    ------
    ArithmeticError
        If no solution was found at the start, or a larger group has none.
    """

    def __init__(
        self,
        balance: SelectedBalance,
        start: float,
        end: float,
        options: ContinuationOptions | None = None,
    ) -> None:
        self.balance = balance
        self._first = group, x, _ = balance.solve(start)
        super().__init__(
            SpeedFamily(balance.full), balance.embed(group, x), start, end, options=options
        )

    def __iter__(self) -> Iterator[Point]:
        for at in self.selected():
            x, tangent = (
                self.balance.embed(at.group, part) for part in (at.point.x, at.point.tangent[:-1])
            )
            yield replace(at.point, x=x, tangent=np.append(tangent, at.point.tangent[-1]))

    def selected(self) -> Iterator[SelectedPoint]:
        """The points in the coefficients in use."""
        balance, options = self.balance, self.options
        group, x, neglect = self._first
        value, direction = self.start, None
        at: SelectedPoint | None = None
        travel = Travel(options)
        while True:
            self.stop = travel.add(0.0)
            if self.stop is not None:
                return
            family = SpeedFamily(balance.balance(group))
            bounds = (self.low, self.high)
            branch = Branch(
                family, x, value, self.end, bounds, options, direction=direction, travel=travel
            )
            for point in branch:
                if at is not None and point.value == at.point.value:
                    continue  # where the branch was taken up again
                neglect = balance.neglect(group, point.value, point.x)
                other = balance.adapt(group, point.x, neglect)
                if neglect.error <= balance.tolerance:
                    at = SelectedPoint(point, group, neglect)
                    yield at
                    if other == group:
                        continue
                if at is None:
                    raise ArithmeticError("the harmonics that solved the start are too few")
                changed = _change(balance, at, other)
                if changed is None:
                    continue
                if at.point is not point and at.group == group:  # refused: a shorter step
                    step = max(
                        0.5 * branch.corrector.distance(at.point, point), options.shortest_step
                    )
                    options = replace(options, first_step=min(step, options.longest_step))
                group, x, value = other, changed, at.point.value
                direction = _regrouped(balance, at, other)
                break
            else:
                self.stop = branch.stop
                return


def _change(balance: SelectedBalance, at: SelectedPoint, group: Group) -> Array | None:
    """The coefficients of a point in another group, corrected at its speed."""
    equations = balance.balance(group).at(at.point.value)
    result = newton(equations, balance.regroup(at.group, group, at.point.x))
    return result.x if result.outcome.converged else None


def _regrouped(balance: SelectedBalance, at: SelectedPoint, group: Group) -> Array:
    """The tangent of a point in another group."""
    tangent = balance.regroup(at.group, group, at.point.tangent[:-1])
    return np.append(tangent, at.point.tangent[-1])
