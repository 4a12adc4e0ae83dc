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
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress
from sfd_hbm_ros.response.curves.parts import both_ways, lies_on
from sfd_hbm_ros.rotor import critical_speeds, hold_journals
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_OPTIONS = ContinuationOptions(eccentricity=0.995)  # nearer to the wall no shock throws a machine
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
        Settings of the continuation, by default up to an eccentricity of 0.995.
    progress : callable, optional
        Called with the speed of every point, on the way to other responses too.

    Returns
    -------
    list of CurveBranch
        Closed branches (`Stop.CLOSED`) and open ones, each found once.
    """
    options = options or _OPTIONS
    family = SpeedFamily(curve.balance)
    found: list[CurveBranch] = []
    for speed in _speeds(curve.balance, lowest, highest, speeds):
        for x in responses_over_unbalance(curve.balance, speed, options, progress):
            response = solution_at(curve.balance, speed, x)
            if not lies_on((*curve.branches, *found), speed, response):
                bounds = lowest, highest
                found.append(both_ways(family, response, speed, bounds, options, progress))
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
