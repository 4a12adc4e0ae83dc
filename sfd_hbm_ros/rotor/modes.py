"""Whirl modes of the rotor on its bearings and centring springs, films left out.

The upper modes of a finite element model belong to its mesh rather than to the rotor.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, splu

from sfd_hbm_ros.rotor.arrays import NumberArray, SparseArray
from sfd_hbm_ros.rotor.directions import Direction, direction, senses
from sfd_hbm_ros.rotor.frames import Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.model import RotorModel
from sfd_hbm_ros.rotor.spectrum import largest_eigenpairs, largest_eigenvalues
from sfd_hbm_ros.threads import one_blas_thread

SHIFT = 1.0
"""Eigenvalues are sought by the reciprocal of their distance from here [rad/s]: the low ones then
come out to full precision, and rigid motions that nothing holds come out as zero."""

HELD = 1e-3
"""Below this frequency a motion counts as rigid and held by nothing [rad/s]."""

MOST = 40
"""Number of whirl modes that are found of a large rotor."""


@dataclass(frozen=True)
class WhirlMode:
    """A free vibration at a constant speed.

    Parameters
    ----------
    frequency : float
        Damped natural frequency, the imaginary part of the eigenvalue [rad/s].
    direction : Direction
        Sense of the orbits.
    """

    frequency: float
    direction: Direction


@one_blas_thread
def whirl_modes(model: RotorModel, speed: float) -> list[WhirlMode]:
    """Return the whirl modes at a speed, in rising order of frequency.

    Overdamped motions, which do not oscillate, and rigid motions that nothing holds are left out.
    A mode whose orbits run forward at some places and backward at others has the sense of the area
    that it sweeps, weighted by the mass that sweeps it. At rest no sense is preferred, and all
    modes count as planar.

    Parameters
    ----------
    model : RotorModel
        The rotor.
    speed : float
        Rotor speed [rad/s].

    Returns
    -------
    list of WhirlMode
        All modes of a rotor of some hundred coordinates; the lowest `MOST` of a larger one.
    """
    M, C, G, K = model.matrices
    damping = C + speed * G
    if is_axisymmetric(model):
        # exp(s t) in x + i y runs forward if Im s > 0, and backward if Im s < 0.
        forward = [Whirl().systems(matrix)[0] for matrix in (M, damping, K)]
        eigenvalues = SHIFT + 1.0 / largest_eigenvalues(_companion(*forward), MOST)
        sense = np.sign(eigenvalues.imag)
    else:
        reciprocals, vectors = largest_eigenpairs(_companion(M, damping, K), 2 * MOST)
        upper = reciprocals.imag < 0.0
        eigenvalues = SHIFT + 1.0 / reciprocals[upper]
        sense = senses(M, vectors[model.size :, upper])
    frequencies = np.abs(eigenvalues.imag)
    # Rounding gives an overdamped motion a frequency of its own.
    oscillates = (frequencies > HELD) & (frequencies > 1e-6 * np.abs(eigenvalues))
    return [
        WhirlMode(float(frequencies[i]), direction(sense[i] if speed else 0.0))
        for i in np.argsort(frequencies)
        if oscillates[i]
    ]


@one_blas_thread
def campbell(model: RotorModel, speeds: Iterable[float]) -> list[list[WhirlMode]]:
    """Return the data of a Campbell diagram.

    Parameters
    ----------
    model : RotorModel
        The rotor.
    speeds : iterable of float
        Rotor speeds [rad/s].

    Returns
    -------
    list of list of WhirlMode
        The modes at each speed, as from `whirl_modes`.
    """
    return [whirl_modes(model, speed) for speed in speeds]


def _companion(M: SparseArray, D: SparseArray, K: SparseArray) -> LinearOperator:
    """Return the matrix with the eigenpairs 1/(s - SHIFT) and (., q), (s^2 M + s D + K) q = 0."""
    n = M.shape[0]
    factors = splu((K + SHIFT * D + SHIFT**2 * M).tocsc())
    upper = D + 2.0 * SHIFT * M

    def product(vectors: NumberArray) -> NumberArray:
        first, second = vectors[:n], vectors[n:]
        return np.concatenate([-factors.solve(upper @ first + M @ second), first])

    return LinearOperator((2 * n, 2 * n), product, matmat=product, dtype=D.dtype)
