"""Continuation in the speed with the harmonics that matter at each point."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.continuation import Branch
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


def selected_branch(
    balance: SelectedBalance,
    start: float,
    end: float,
    options: ContinuationOptions | None = None,
) -> Iterator[SelectedPoint]:
    """Follow the response from one speed [rad/s] to another, in the harmonics that matter.

    Every point lies within the tolerance of the trial group's solution, by the estimate of
    `SelectedBalance.neglect`. A group that is too small at a point is enlarged, and the step taken
    again; one that is too large shrinks for the following steps.

    Raises
    ------
    ArithmeticError
        If no solution was found at the start, or a larger group has none.
    """
    options = options or ContinuationOptions()
    bounds = (min(start, end), max(start, end))
    group, x, neglect = balance.solve(start)
    value, direction = start, None
    at: SelectedPoint | None = None
    while True:
        family = SpeedFamily(balance.balance(group))
        branch = Branch(family, x, value, end, bounds, options, direction=direction)
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
                raise ArithmeticError("the group of harmonics that solved the start is too small")
            changed = _change(balance, at, other)
            if changed is None:
                continue
            if at.point is not point and at.group == group:  # the step was refused: a shorter one
                step = max(0.5 * branch.distance(at.point, point), options.shortest_step)
                options = replace(options, first_step=min(step, options.longest_step))
            group, x, value = other, changed, at.point.value
            direction = _regrouped(balance, at, other)
            break
        else:
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
