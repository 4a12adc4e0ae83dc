"""How far the responses of a machine lie from a curve that was computed for another state of it.

Where loads, oil or parameters have changed a little, the curve still tells where the machine
would jump. Whether it does is judged by what matters, the responses, and not by the parameters:
a load of a thousandth of the weight is another number, but no other response.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Solution
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.rotor import ResonanceError

HOLDS = 0.05
"""Deviation, in clearances, up to which a curve still tells of a machine."""

_SPEED = 0.1  # part of the speed that counts as much as one clearance
_EVENLY = 3  # points of each branch beside its folds and its greatest orbit
_MOST = 6  # points of one curve: each takes a millisecond or two


def landmarks(curve: ResponseCurve) -> tuple[Solution, ...]:
    """Responses by which a curve over the speed is compared with machines.

    They are where a machine would jump, at folds and greatest orbits, and some between; where the
    machine cannot be, on unstable parts, nothing is compared.
    """
    branches = [branch for branch in curve.branches if branch.periodic]
    jumps = [one for branch in branches for one in _chosen(branch, _extremes(branch))]
    between = [one for branch in branches for one in _chosen(branch, _evenly(branch))]
    return tuple((jumps + between)[:_MOST])


def deviation(balance: HarmonicBalance, responses: Iterable[Solution]) -> float:
    """Greatest distance of a machine's responses from others, in clearances.

    From each response the nearest one of the machine is sought by a single step of Newton's
    method in which the speed is free. So it is the distance of two curves, and at a fold it tells
    how far that moves; a tenth of the speed counts as much as a clearance. At a resonance of the
    held rotor, where there are no equations, nothing is compared.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    responses : iterable of Solution
        The others; those in other harmonics are left out.

    Returns
    -------
    The distance; infinite where it cannot be computed, or nothing could be compared.
    """
    distances = []
    for response in responses:
        if response.harmonics != balance.harmonics:
            continue
        try:
            with np.errstate(all="ignore"):  # where numbers overflow it cannot be computed
                step = _step(balance, response)
        except ResonanceError:
            continue
        except (ArithmeticError, ValueError):  # LinAlgError is a ValueError
            return np.inf
        if not np.isfinite(step):
            return np.inf
        distances.append(step)
    return max(distances, default=np.inf)


def _step(balance: HarmonicBalance, response: Solution) -> float:
    """The shortest step from a response to one of the machine at any speed, in clearances."""
    equations, x = balance.at(response.speed), response.coefficients.ravel()
    residual, jacobian = equations.linearise(x)
    slope = equations.slope_by_speed(x) * _SPEED * response.speed
    matrix = np.column_stack([jacobian * equations.scale, slope])
    step, *_ = np.linalg.lstsq(matrix, residual, rcond=None)
    return float(np.abs(step).max())


def _chosen(branch: CurveBranch, points: Iterable[int]) -> Iterator[Solution]:
    return (branch.orbits[point] for point in points)


def _extremes(branch: CurveBranch) -> list[int]:
    """Folds, and the greatest orbit that is stable."""
    folds: list[int] = np.flatnonzero(branch.fold).tolist()
    stable = np.flatnonzero(branch.stable)
    if not stable.size:
        return folds
    greatest = int(stable[np.argmax(branch.worst_eccentricity[stable])])
    return sorted({*folds, greatest})


def _evenly(branch: CurveBranch) -> list[int]:
    """Stable points at even distances."""
    stable = np.flatnonzero(branch.stable)
    if not stable.size:
        return []
    chosen = np.linspace(0, stable.size - 1, _EVENLY).round().astype(int)
    return sorted(set(stable[chosen].tolist()))
