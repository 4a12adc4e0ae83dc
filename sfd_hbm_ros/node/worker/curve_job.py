"""What the worker process computes: the response curve of a machine. Without ROS."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.rotor import RotorModel
from sfd_hbm_ros.rotor.criticals import critical_speeds


@dataclass(frozen=True)
class CurveJob:
    """A response curve that is asked for.

    Parameters
    ----------
    machine : Machine
        The machine with the loads that act on it.
    harmonics : int
        The highest harmonic to balance.
    lowest, highest : float
        Range of the speed [rad/s].
    detached : bool
        Whether to look for detached branches, too.
    revision : int
        Which of the states of the machine it is that curves were asked for.
    """

    machine: Machine
    harmonics: int
    lowest: float
    highest: float
    detached: bool = False
    revision: int = 0


@dataclass(frozen=True, eq=False)
class CurveResult:
    """A response curve that was asked for.

    Attributes
    ----------
    job : CurveJob
        What was asked for.
    curve : ResponseCurve
        The curve, with the eccentricities of all points computed.
    detached : tuple of CurveBranch or None
        Detached branches; None where they were not asked for, or are still being looked for.
    seconds : float
        Time it took [s].
    critical : float
        First critical speed without the films [rad/s]; NaN if there is none.
    """

    job: CurveJob
    curve: ResponseCurve
    detached: tuple[CurveBranch, ...] | None
    seconds: float
    critical: float

    @property
    def complete(self) -> bool:
        """Whether nothing is to follow."""
        return self.detached is not None or not self.job.detached


@dataclass(frozen=True)
class Failure:
    """Why there is no result.

    Attributes
    ----------
    reason : str
        The reason in words.
    final : bool
        Whether another attempt would end the same way.
    traceback : str
        Where it happened, if nobody expected it.
    """

    reason: str
    final: bool
    traceback: str = ""


def compute(job: CurveJob, progress: Callable[[float], None]) -> Iterator[CurveResult]:
    """Compute a response curve.

    Parameters
    ----------
    job : CurveJob
        What is asked for.
    progress : callable
        Called with the speed [rad/s] of every new point.

    Yields
    ------
    CurveResult
        The curve as soon as it is whole, and once more with its detached branches if they are
        asked for: to look for them takes several times longer.

    Raises
    ------
    MachineError, NoSolutionError
        If the machine cannot be balanced, or has no solution at an end of the range.
    """
    start = time.monotonic()
    # Where numbers overflow there is no solution: that is said, not warned about.
    with np.errstate(all="ignore"):
        balance = HarmonicBalance(job.machine, Harmonics(job.harmonics))
        curve = response_curve(balance, job.lowest, job.highest, progress=progress)
        _measure(curve.branches)
        critical = _first_critical(balance.model)
        result = CurveResult(job, curve, None, time.monotonic() - start, critical)
    yield result
    if not job.detached:
        return
    with np.errstate(all="ignore"):
        detached = tuple(detached_branches(curve, job.lowest, job.highest, progress=progress))
        _measure(detached)
    yield replace(result, detached=detached, seconds=time.monotonic() - start)


def _first_critical(model: RotorModel) -> float:
    """The first critical speed [rad/s]; NaN where none can be computed."""
    try:
        return min((one.speed for one in critical_speeds(model)), default=math.nan)
    except (ArithmeticError, RuntimeError, ValueError):
        return math.nan


def _measure(branches: Iterable[CurveBranch]) -> None:
    """Compute the eccentricities of branches here, where the time that takes delays nobody.

    They are cached and sent with them.
    """
    for branch in branches:
        _ = branch.worst_eccentricity
