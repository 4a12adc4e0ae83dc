"""Frames in which the equations of one harmonic, P q = f, are solved.

`Cartesian` takes the coordinates (x, y) as they come: one system of equations. `Whirl` splits a
harmonic into a forward and a backward circle, x + i y = a exp(i w t) + conj(b) exp(-i w t):

    a = (X + i Y) / 2,    b = (X - i Y) / 2,    X = a + b,    Y = -i (a - b)

for x = Re(X exp(i w t)) and y = Re(Y exp(i w t)). Where the machine is axisymmetric, every 2x2
block of its matrices being [[p, q], [-q, p]], the two circles do not couple: the forward one obeys
p - i q, the backward one p + i q, each with half of the unknowns and of the bandwidth.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Protocol

import numpy as np

from sfd_hbm_ros.kernels import kernel
from sfd_hbm_ros.rotor.arrays import ComplexArray, NumberArray, RealArray
from sfd_hbm_ros.rotor.model import RotorModel


class Frame(Protocol):
    """A choice of coordinates in which P q = f falls into one or more systems."""

    def systems(self, matrix: RealArray) -> ComplexArray:
        """Return the systems' matrices (s, n, m) of a real matrix in x, y interleaved."""

    def split(self, vector: ComplexArray) -> ComplexArray:
        """Return the systems' vectors (..., s, n) of amplitudes in x, y interleaved."""

    def join(self, vectors: NumberArray) -> ComplexArray:
        """Undo `split`."""

    def join_matrices(self, matrices: NumberArray) -> ComplexArray:
        """Return the matrices (..., N, N) in x, y of the systems' matrices (..., s, n, n)."""


class Cartesian:
    """Coordinates x and y as they are, for any machine: one system."""

    def systems(self, matrix: RealArray) -> ComplexArray:
        """See `Frame`."""
        return matrix[np.newaxis].astype(complex)

    def split(self, vector: ComplexArray) -> ComplexArray:
        """See `Frame`."""
        return vector[..., np.newaxis, :]

    def join(self, vectors: NumberArray) -> ComplexArray:
        """See `Frame`."""
        return vectors[..., 0, :].astype(complex)

    def join_matrices(self, matrices: NumberArray) -> ComplexArray:
        """See `Frame`."""
        return matrices[..., 0, :, :].astype(complex)


class Whirl:
    """Forward and backward circles of an axisymmetric machine: two systems."""

    def systems(self, matrix: RealArray) -> ComplexArray:
        """See `Frame`."""
        forward = matrix[0::2, 0::2] - 1j * matrix[0::2, 1::2]
        return np.stack([forward, forward.conj()])

    def split(self, vector: ComplexArray) -> ComplexArray:
        """See `Frame`."""
        x, iy = vector[..., 0::2], 1j * vector[..., 1::2]
        return np.stack([x + iy, x - iy], axis=-2) / 2.0

    def join(self, vectors: NumberArray) -> ComplexArray:
        """See `Frame`."""
        forward, backward = vectors[..., 0, :], vectors[..., 1, :]
        x_y = np.stack([forward + backward, -1j * (forward - backward)], axis=-1)
        return x_y.reshape(*x_y.shape[:-2], -1)

    def join_matrices(self, matrices: NumberArray) -> ComplexArray:
        """See `Frame`."""
        *outer, systems, n, _ = matrices.shape
        flat = matrices.astype(complex, order="C").reshape(math.prod(outer), systems, n, n)
        joined = _joined(flat)
        return joined.reshape(*outer, 2 * n, 2 * n)


@kernel("complex128[:, :, ::1](complex128[:, :, :, ::1])")
def _joined(systems: ComplexArray) -> ComplexArray:
    """Matrices (m, 2n, 2n) in x, y of those of forward and backward circles (m, 2, n, n)."""
    m, _, n, _ = systems.shape
    joined = np.empty((m, 2 * n, 2 * n), dtype=np.complex128)
    for k in range(m):
        for i in range(n):
            for j in range(n):
                forward, backward = 0.5 * systems[k, 0, i, j], 0.5 * systems[k, 1, i, j]
                across = 1j * (forward - backward)
                joined[k, 2 * i, 2 * j] = joined[k, 2 * i + 1, 2 * j + 1] = forward + backward
                joined[k, 2 * i, 2 * j + 1], joined[k, 2 * i + 1, 2 * j] = across, -across
    return joined


@lru_cache(maxsize=8)
def is_axisymmetric(model: RotorModel) -> bool:
    """Tell whether every 2x2 block of a rotor's matrices is [[p, q], [-q, p]].

    The answer is kept, as the same rotor is asked about at every speed.
    """
    return all(
        _alike(matrix[0::2, 0::2], matrix[1::2, 1::2], matrix)
        and _alike(matrix[0::2, 1::2], -matrix[1::2, 0::2], matrix)
        for matrix in (model.M, model.C, model.G, model.K)
    )


def _alike(one: RealArray, other: RealArray, whole: RealArray) -> bool:
    """Tell whether two parts of a matrix differ by no more than rounding."""
    return bool(np.abs(one - other).max(initial=0.0) <= 1e-14 * np.abs(whole).max(initial=0.0))
