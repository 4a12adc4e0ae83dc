"""All responses at one speed: a nonlinear machine may have several, and its history chooses.

They are sought on the branch in the unbalance at that speed, and on the branches in the speed
through each that is known. A response that neither leads to is not found.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Solution
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.curves.detached import responses_over_unbalance
from sfd_hbm_ros.response.responses import SAME, balanced, distance
from sfd_hbm_ros.rotor import ResonanceError

Array = NDArray[np.float64]

_ASIDE = 1.5  # factor of the speed up and down to which a branch may lead before it comes back
_OPTIONS = ContinuationOptions(points=400)


def coexisting_solutions(
    balance: HarmonicBalance, speed: float, known: Solution | None = None
) -> list[Solution]:
    """Other periodic responses of a machine at a speed, stable and unstable.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    speed : float
        Rotor speed [rad/s].
    known : Solution, optional
        A converged solution at that speed, which is left out of what is returned.

    Returns
    -------
    list of Solution
        Each once, in rising order of the greatest eccentricity.
    """
    found = [] if known is None else [known]
    for solution in _over_unbalance(balance, speed):
        _add(found, solution)
    for solution in found:  # which grows meanwhile
        for other in _over_speed(balance, solution):
            _add(found, other)
    others = [one for one in found if one is not known]
    return sorted(others, key=lambda one: one.eccentricity_max)


def _add(found: list[Solution], solution: Solution) -> None:
    if all(distance(solution, one) > SAME for one in found):
        found.append(solution)


def _over_unbalance(balance: HarmonicBalance, speed: float) -> Iterator[Solution]:
    try:
        for x in responses_over_unbalance(balance, speed, _OPTIONS, None):
            yield solution_at(balance, speed, x)
    except ResonanceError:
        return


def _over_speed(balance: HarmonicBalance, start: Solution) -> Iterator[Solution]:
    """Where the branch through a solution comes back to its speed, on the way up and down."""
    speed = start.speed
    bounds = speed / _ASIDE, speed * _ASIDE
    for end in bounds:
        branch = Branch(SpeedFamily(balance), start.unknowns, speed, end, bounds, options=_OPTIONS)
        before = None
        try:
            for point in branch:
                if before is not None and (before.value - speed) * (point.value - speed) < 0.0:
                    there = locate(branch, before, point, lambda at: at.value - speed)
                    if there is not None:
                        yield from _corrected(balance, speed, there.x)
                before = point
        except (ResonanceError, np.linalg.LinAlgError):
            continue


def _corrected(balance: HarmonicBalance, speed: float, x: Array) -> Iterator[Solution]:
    equations = balance.at(speed)
    result = newton(equations, x)
    if balanced(equations, result):
        yield solution_at(balance, speed, result.x)
