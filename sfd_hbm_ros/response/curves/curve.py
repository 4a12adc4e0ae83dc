"""The response curve of a machine: every branch that a run-up or a coast-down can meet."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import MachineFamily, ParameterFamily, SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.selected_branch import SelectedBranch
from sfd_hbm_ros.hbm.selection import SelectedBalance
from sfd_hbm_ros.response.curves.forks import Fork, leaving_branches
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress
from sfd_hbm_ros.response.curves.parts import Gap, follow_parts, gaps
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.threads import one_blas_thread
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ResponseCurve:
    """Response of a machine over a range of one parameter.

    Attributes
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    family : Family
        The equations as the parameter varies.
    branches : tuple of CurveBranch
        The branch that begins at the start of the range first. Where it does not lead to the
        range's end, the one that begins there follows, and those found between (see
        `follow_parts`), and then those that leave others.
    forks : tuple of Fork
        Where branches leave others.
    detached : tuple of CurveBranch
        Detached branches, where they were looked for (see `detached_branches`). A journey through
        the range does not meet them.
    gaps : tuple of Gap
        Where in the range no response was found.
    """

    balance: HarmonicBalance
    family: MachineFamily
    branches: tuple[CurveBranch, ...]
    forks: tuple[Fork, ...] = ()
    detached: tuple[CurveBranch, ...] = ()
    gaps: tuple[Gap, ...] = ()

    @property
    def every_branch(self) -> tuple[CurveBranch, ...]:
        """The branches, the detached ones last."""
        return (*self.branches, *self.detached)

    @property
    def dampers(self) -> tuple[str, ...]:
        """Names of the dampers."""
        return tuple(damper.name for damper in self.balance.machine.dampers)

    @property
    def harmonics(self) -> Harmonics:
        """Harmonics that hold those of every branch of periodic responses."""
        others = [branch.solutions[0].harmonics for branch in self.branches if branch.periodic]
        return max(self.balance.harmonics, *others, key=lambda group: group.revolutions)

    def meeting(self, branch: CurveBranch, point: int) -> list[tuple[CurveBranch, int]]:
        """Points of other branches with which a branch's point is one."""
        return [
            other
            for fork in self.forks
            for own, other in (fork.sides, reversed(fork.sides))
            if own == (branch, point)
        ]


@one_blas_thread
def response_curve(
    balance: HarmonicBalance,
    lowest: float,
    highest: float,
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> ResponseCurve:
    """Follow the response over a range of speeds.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    lowest, highest : float
        Range of the speed [rad/s].
    options : ContinuationOptions, optional
        Settings of the continuation.
    progress : callable, optional
        Called with the speed of every new point.

    Raises
    ------
    NoSolutionError
        If no solution was found in the range.
    """
    family = SpeedFamily(balance)
    branch_from = partial(_solved_branch, family, options)
    return _curve(family, lowest, highest, options, progress, branch_from)


@one_blas_thread
def selected_curve(
    balance: SelectedBalance,
    lowest: float,
    highest: float,
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> ResponseCurve:
    """Follow the response over a range of speeds in the harmonics that matter at each.

    Parameters and errors are those of `response_curve`. The coefficients are those of the trial
    group, and zero where a harmonic is not in use; folds and the branches that leave others are
    computed in the whole group.
    """

    def branch_from(start: float, end: float) -> Branch:
        try:
            return SelectedBranch(balance, start, end, options)
        except ArithmeticError as error:
            raise _no_solution(start, str(error)) from None

    family = SpeedFamily(balance.full)
    return _curve(family, lowest, highest, options, progress, branch_from)


@one_blas_thread
def parameter_curve(
    balance: HarmonicBalance,
    speed: float,
    path: str,
    start: float,
    end: float,
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> ResponseCurve:
    """Follow the response at one speed [rad/s] over a range of an entry of the machine file.

    Further parameters and errors are those of `response_curve`; `path` is dotted.

    Raises
    ------
    MachineError
        If the machine cannot be with the value at an end of the range.
    """
    family = ParameterFamily(balance, speed, path, (min(start, end), max(start, end)))
    for value in (start, end):  # before anything is computed
        family.machine(value)
    branch_from = partial(_solved_branch, family, options)
    return _curve(family, start, end, options, progress, branch_from)


def _curve(
    family: MachineFamily,
    start: float,
    end: float,
    options: ContinuationOptions | None,
    progress: Progress | None,
    branch_from: Callable[[float, float], Branch],
) -> ResponseCurve:
    parts = follow_parts(family, start, end, branch_from, options, progress)
    bounds = min(start, end), max(start, end)
    switched, forks = leaving_branches(family, parts, bounds, options, progress)
    branches = *parts, *switched
    return ResponseCurve(family.balance, family, branches, forks, gaps=gaps(branches, bounds))


def _solved_branch(
    family: MachineFamily, options: ContinuationOptions | None, start: float, end: float
) -> Branch:
    """The branch that begins with the solution at `start`, towards `end`."""
    equations = family.at(start)
    first = solve(equations.balance, equations.speed)
    if not first.converged:
        raise _no_solution(first.speed, first.message)
    return Branch(family, first.coefficients.ravel(), start, end, options=options)


def _no_solution(speed: float, reason: str) -> NoSolutionError:
    return NoSolutionError(f"no solution at {speed / RPM:g} rpm: {reason}")
