"""Detached branches: responses that no run-up meets, but onto which a shock can throw a machine.

At some speeds the unbalance is raised from a small part of itself and followed by arclength past
its folds. Where the branch in the unbalance comes through the full unbalance again it has found
another response, and if that lies on no known branch it is followed in speed both ways.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, solve_equations
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import LoadFamily, SpeedFamily
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress, judged
from sfd_hbm_ros.response.curves.jumps import solutions_at
from sfd_hbm_ros.response.responses import SAME, distance
from sfd_hbm_ros.rotor import critical_speeds, hold_journals
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_LEAST, _MOST = 0.05, 20.0  # parts of the unbalance between which it is followed


@one_blas_thread
def detached_branches(
    curve: ResponseCurve,
    lowest: float,
    highest: float,
    speeds: int | Sequence[float] = 9,
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> list[CurveBranch]:
    """Branches of a machine that its response curve does not reach.

    Parameters
    ----------
    curve : ResponseCurve
        The response over the speed.
    lowest, highest : float
        Range of the speed [rad/s].
    speeds : int or sequence of float
        Speeds [rad/s] at which other responses are looked for, or the number of speeds that are
        evenly spaced over the range. They are also looked for just below the critical speeds
        of the shaft with its journals held, where a damper closes on its clearance. A detached
        branch that spans none of these is not found.
    options : ContinuationOptions, optional
        Settings of the continuation.
    progress : callable, optional
        Called with the speed of every point, on the way to other responses too.

    Returns
    -------
    list of CurveBranch
        Closed branches (`Stop.CLOSED`) and open ones, each found once.
    """
    found: list[CurveBranch] = []
    for speed in _speeds(curve.balance, lowest, highest, speeds):
        for x in responses_over_unbalance(curve.balance, speed, options, progress):
            if _known((*curve.branches, *found), curve, speed, x):
                continue
            bounds = lowest, highest
            found.append(_both_ways(curve.balance, x, speed, bounds, options, progress))
    return found


def _speeds(
    balance: HarmonicBalance, lowest: float, highest: float, speeds: int | Sequence[float]
) -> Array:
    """Speeds at which to look [rad/s]."""
    given = np.linspace(lowest, highest, speeds) if isinstance(speeds, int) else speeds
    held = [critical.speed for critical in critical_speeds(hold_journals(balance.model))]
    below = np.multiply.outer(held, [0.998, 0.99]).ravel()
    inside = below[(below > lowest) & (below < highest)]
    return np.unique(np.concatenate([given, inside]))


def responses_over_unbalance(
    balance: HarmonicBalance,
    speed: float,
    options: ContinuationOptions | None,
    progress: Progress | None,
) -> Iterator[Array]:
    """Coefficients (n,) of the responses at a speed that one branch in the unbalance connects."""
    equations = balance.at(speed)
    static = np.zeros_like(equations.force)
    static[0] = equations.force[0]
    unbalance = equations.force - static
    family = LoadFamily(equations, static, unbalance)
    start, _ = solve_equations(family.at(_LEAST))
    if not start.outcome.converged:
        return
    before = None
    for point in Branch(family, start.x, _LEAST, _MOST, options=options):
        if progress is not None:
            progress(speed)
        if before is not None and (before.value - 1.0) * (point.value - 1.0) < 0.0:
            part = (1.0 - before.value) / (point.value - before.value)
            result = newton(equations, before.x + part * (point.x - before.x))
            if result.outcome.converged:
                yield result.x
        before = point


def _known(
    branches: tuple[CurveBranch, ...], curve: ResponseCurve, speed: float, x: Array
) -> bool:
    """Whether a response lies on one of the branches."""
    own = solution_at(curve.balance, speed, x)
    return any(
        distance(solution, own) < SAME
        for branch in branches
        for _, solution in solutions_at(branch, speed)
    )


def _both_ways(
    balance: HarmonicBalance,
    x: Array,
    speed: float,
    bounds: tuple[float, float],
    options: ContinuationOptions | None,
    progress: Progress | None,
) -> CurveBranch:
    """The branch through a response, closed or followed to both ends of it in the range."""
    family = SpeedFamily(balance)
    if speed in bounds:
        other = bounds[1] if speed == bounds[0] else bounds[0]
        return judged(Branch(family, x, speed, other, bounds, options), progress)
    ahead = judged(Branch(family, x, speed, bounds[1], bounds, options), progress)
    if ahead.stop is Stop.CLOSED:
        return ahead
    behind = judged(Branch(family, x, speed, bounds[0], bounds, options), progress)
    return CurveBranch(
        family,
        np.concatenate([behind.values[:0:-1], ahead.values]),
        behind.solutions[:0:-1] + ahead.solutions,
        behind.instability[:0:-1] + ahead.instability,
        np.concatenate([behind.fold[:0:-1], ahead.fold]),
        ahead.stop,
    )
