"""Critical speeds of the rotor on its bearings and centring springs, films left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, splu

from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray, SparseArray
from sfd_hbm_ros.rotor.directions import Direction, direction, senses
from sfd_hbm_ros.rotor.frames import Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.model import RotorModel
from sfd_hbm_ros.rotor.modes import HELD, SHIFT
from sfd_hbm_ros.rotor.spectrum import largest_eigenpairs
from sfd_hbm_ros.threads import one_blas_thread

_REACH = 10.0  # multiple of the first critical speed up to which they are found
_FIRST = 16  # number of modes that are sought first


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a mode of the undamped rotor whirls just as fast as the rotor turns.

    Parameters
    ----------
    speed : float
        Rotor speed [rad/s].
    direction : Direction
        Sense of the mode's orbits. The unbalance of an axisymmetric rotor excites forward modes.
    """

    speed: float
    direction: Direction


@one_blas_thread
def critical_speeds(model: RotorModel) -> list[CriticalSpeed]:
    """Return the critical speeds up to ten times the first, in rising order.

    A whirl exp(i W t) at the speed W obeys (K - W^2 (M - i G)) q = 0, which is linear in W^2.
    Damping is left out, and so is what differs between the cross-coupled stiffnesses xy and yx of
    a bearing, since that too feeds or drains a whirl.

    Parameters
    ----------
    model : RotorModel
        The rotor.

    Returns
    -------
    list of CriticalSpeed
        The critical speeds, forward, backward and planar.
    """
    M, G, K = model.matrices.M, model.matrices.G, model.matrices.K
    symmetric = 0.5 * (K + K.T)
    if is_axisymmetric(model):
        (stiffness, _), (mass, _), gyroscopic = map(Whirl().systems, (symmetric, M, G))
        found = [
            (speed, sense)
            for sense, term in zip((1.0, -1.0), gyroscopic, strict=True)
            for speed in _speeds(stiffness, mass - 1j * term)[0]
        ]
    else:
        speeds, shapes = _speeds(symmetric, M - 1j * G)
        found = list(zip(speeds, senses(M, shapes), strict=True))
    criticals = [CriticalSpeed(float(speed), direction(sense)) for speed, sense in sorted(found)]
    return [critical for critical in criticals if critical.speed <= _REACH * criticals[0].speed]


def _speeds(stiffness: SparseArray, inertia: SparseArray) -> tuple[RealArray, ComplexArray]:
    """Return speeds W (m,) and shapes q (n, m) of (K - W^2 B) q = 0, all up to the reach.

    Each eigenvalue sought is 1 / (W^2 + SHIFT^2). It is negative for a forward mode that polar
    inertia stiffens more than mass softens it: such a mode outruns the speed for ever.
    """
    shifted = splu((stiffness + SHIFT**2 * inertia).tocsc())

    def flexibility(vectors: ComplexArray) -> ComplexArray:
        return np.asarray(shifted.solve(inertia @ vectors))

    shape, count = inertia.shape, _FIRST
    operator = LinearOperator(shape, flexibility, matmat=flexibility, dtype=complex)
    while True:
        values, shapes = largest_eigenpairs(operator, count)
        squares = 1.0 / values.real - SHIFT**2
        real = squares > HELD**2
        farthest = 1.0 / np.abs(values).min()
        if len(values) == shape[0] or farthest > _REACH**2 * squares[real].min(initial=np.inf):
            return np.sqrt(squares[real]), shapes[:, real]
        count *= 2
