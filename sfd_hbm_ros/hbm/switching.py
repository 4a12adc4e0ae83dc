"""Switching to the branch that leaves another where a response loses a symmetry of its own.

At a period doubling a Floquet multiplier is -1: a disturbance that changes its sign with every
revolution neither grows nor decays, so the harmonic balance over two revolutions has a singular
Jacobian there, with a null vector of half orders. Where a multiplier is 1 without a fold, the
Jacobian over the response's own period is singular, with a null vector of those coefficients that
the response does not have, such as even orders in an orbit that is its own mirror image. Along
the null vector a branch leaves both ways; its halves are the same motion, shifted or mirrored
(Nayfeh and Balachandran 1995, Applied Nonlinear Dynamics, sec. 3.5).
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.corrector import Corrector
from sfd_hbm_ros.hbm.family import Family, FamilyMember, MachineFamily
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Point, Stop
from sfd_hbm_ros.hbm.solution import Solution

Array = NDArray[np.float64]

_ABSENT = 1e-8  # of the clearance, below which a response does not have a coefficient
_STEPS = (0.02, 0.01, 0.005, 0.05)  # of the clearance, with which the other branch is sought


class SwitchedBranch(Branch):
    """A branch that leaves another, followed until it joins that or any like it again.

    Parameters
    ----------
    family : Family
        The equations over the period of the new branch.
    first : Point
        Its first point, whose tangent leads away from the other branch.
    absent : (n,) boolean array
        The coefficients that responses of the other branch do not have.
    bounds : (2,) tuple of float
        Range of the parameter.
    options : ContinuationOptions, optional
        Settings of the continuation.
    """

    def __init__(
        self,
        family: Family,
        first: Point,
        absent: NDArray[np.bool_],
        bounds: tuple[float, float],
        options: ContinuationOptions | None = None,
    ) -> None:
        super().__init__(
            family, first.x, first.value, bounds[1], bounds, options, direction=first.tangent
        )
        self._absent = absent

    def __iter__(self) -> Iterator[Point]:
        before: Point | None = None
        for point in super().__iter__():
            # through the other branch it would lead on to its own image
            if before is not None and before.x[self._absent] @ point.x[self._absent] < 0.0:
                self.stop = Stop.JOINED
                return
            yield point
            before = point


def switch(
    family: MachineFamily,
    value: float,
    solution: Solution,
    periods: int,
    bounds: tuple[float, float],
    options: ContinuationOptions | None = None,
) -> SwitchedBranch | None:
    """The branch that leaves another at one of its points.

    Parameters
    ----------
    family : SpeedFamily or ParameterFamily
        The machine as the parameter varies, in any harmonics.
    value : float
        The parameter at the point.
    solution : Solution
        The response there.
    periods : int
        Periods of that response in one of the new branch: 2 at a period doubling, 1 where only a
        symmetry breaks.
    bounds : (2,) tuple of float
        Range of the parameter.
    options : ContinuationOptions, optional
        Settings of the continuation.

    Returns
    -------
    SwitchedBranch
        None where the response has no symmetry to lose or no point beside it was found.
    """
    family = over(family, solution.harmonics, periods)
    harmonics = family.balance.harmonics
    x = harmonics.change_from(solution.harmonics, solution.coefficients).ravel()
    absent = absent_coefficients(family.balance, x)
    if not absent.any():
        return None
    tangent = np.append(null_vector(family.at(value), x, absent), 0.0)
    root = Point(value, x, tangent, solution.eccentricity_max, 0)
    first = point_beside(family, root, bounds, options)
    return SwitchedBranch(family, first, absent, bounds, options) if first else None


def point_beside(
    family: Family,
    root: Point,
    bounds: tuple[float, float],
    options: ContinuationOptions | None = None,
) -> Point | None:
    """A point of the branch that leaves a root along its tangent, within the bounds, if any."""
    corrector = Corrector(family, root.value, bounds, options)
    for step in _STEPS:
        point = corrector.corrected(root, step)
        if point is not None and bounds[0] <= point.value <= bounds[1]:
            return point
    return None


def breaks_symmetry(equations: FamilyMember, x: Array) -> bool:
    """Whether the Jacobian at x is nearest to singular in coefficients that x does not have.

    If it is singular, that tells a branch that leaves from a fold.
    """
    absent = absent_coefficients(equations.balance, x)
    _, jacobian = equations.linearise(x)
    nearest = np.linalg.svd(jacobian * equations.scale)[2][-1]
    return bool(np.linalg.norm(nearest[absent]) > 0.5)


def over(family: MachineFamily, harmonics: Harmonics, periods: int) -> MachineFamily:
    """The equations over some periods of a response, in all orders up to its highest."""
    longer = Harmonics(
        harmonics.highest, periods * harmonics.samples, periods * harmonics.revolutions
    )
    balance = family.balance
    return replace(family, balance=HarmonicBalance(balance.machine, longer, balance.model))


def null_vector(equations: FamilyMember, x: Array, absent: NDArray[np.bool_]) -> Array:
    """Direction in the clearance-scaled coefficients along which the forces stay in balance.

    Parameters
    ----------
    equations : FamilyMember
        Equations at a point where a branch leaves another.
    x : (n,) array
        Coefficients of the response there [m].
    absent : (n,) boolean array
        Those which the response does not have. Its Jacobian does not couple them with the others.

    Returns
    -------
    (n,) array of norm 1, zero but for the absent coefficients: the right singular vector of the
    smallest singular value of the Jacobian.
    """
    _, jacobian = equations.linearise(x)
    block = (jacobian * equations.scale)[np.ix_(absent, absent)]
    vector = np.zeros(x.size)
    vector[absent] = np.linalg.svd(block)[2][-1]
    return vector


def absent_coefficients(balance: HarmonicBalance, x: Array) -> NDArray[np.bool_]:
    """Which of its coefficients (rows n,) a response does not have.

    A cosine and its sine go together, whatever the phase.
    """
    harmonics = balance.harmonics
    shaped = x.reshape(harmonics.rows, -1) / balance.clearances
    amplitudes = np.abs(harmonics.amplitudes(shaped))
    missing = amplitudes < _ABSENT
    rows = np.concatenate([missing[:1], np.repeat(missing[1:], 2, axis=0)])
    return rows.ravel()
