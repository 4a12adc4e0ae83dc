"""The response curve of a machine: every branch that a run-up or a coast-down can meet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import Family, ParameterFamily, SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.judged import CurveBranch, Progress, judged

Array = NDArray[np.float64]


class NoSolutionError(RuntimeError):
    """The machine has no solution where one was asked for, or none was found."""


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
        range's end, the branch that begins there follows.
    """

    balance: HarmonicBalance
    family: Family
    branches: tuple[CurveBranch, ...]

    @property
    def dampers(self) -> tuple[str, ...]:
        """Names of the dampers."""
        return tuple(damper.name for damper in self.balance.machine.dampers)


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
        If no solution was found at an end of the range.
    """
    return _curve(balance, SpeedFamily(balance), lowest, highest, options, progress)


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
    """
    family = ParameterFamily(balance, speed, path)
    return _curve(balance, family, start, end, options, progress)


def _curve(
    balance: HarmonicBalance,
    family: Family,
    start: float,
    end: float,
    options: ContinuationOptions | None,
    progress: Progress | None,
) -> ResponseCurve:
    first = _follow(family, start, end, options, progress)
    branches = [first]
    if first.stop is not Stop.RANGE or first.values[-1] != end:
        branches.append(_follow(family, end, start, options, progress))
    return ResponseCurve(balance, family, tuple(branches))


def _follow(
    family: Family,
    start: float,
    end: float,
    options: ContinuationOptions | None,
    progress: Progress | None,
) -> CurveBranch:
    """The branch that begins with the solution at `start`, towards `end`."""
    equations = family.at(start)
    first = solve(equations.balance, equations.speed)
    if not first.converged:
        rpm = first.speed * 30.0 / np.pi
        raise NoSolutionError(f"no solution at {rpm:g} rpm: {first.message}")
    branch = Branch(family, first.coefficients.ravel(), start, end, options=options)
    return judged(branch, progress)
