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
from typing import NamedTuple, Protocol

import numpy as np
from scipy.sparse import csr_array

from sfd_hbm_ros.kernels import kernel
from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, NumberArray, SparseArray
from sfd_hbm_ros.rotor.model import RotorModel


class Entries(NamedTuple):
    """Entries of a sparse matrix, (e,) each; those at the same place add up."""

    row: IndexArray
    column: IndexArray
    value: NumberArray


class Frame(Protocol):
    """A choice of coordinates in which P q = f falls into one or more systems."""

    def entries(self, matrix: SparseArray) -> tuple[Entries, ...]:
        """Return the entries of the systems' matrices of a real one in x, y interleaved."""

    def split(self, vector: ComplexArray) -> ComplexArray:
        """Return the systems' vectors (..., s, n) of amplitudes in x, y interleaved."""

    def join(self, vectors: NumberArray) -> ComplexArray:
        """Undo `split`."""

    def join_matrices(self, matrices: NumberArray) -> ComplexArray:
        """Return the matrices (..., N, N) in x, y of the systems' matrices (..., s, n, n)."""


class Cartesian:
    """Coordinates x and y as they are, for any machine: one system."""

    def entries(self, matrix: SparseArray) -> tuple[Entries, ...]:
        """See `Frame`."""
        found = matrix.tocoo()
        return (Entries(found.row, found.col, found.data),)

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

    def entries(self, matrix: SparseArray) -> tuple[Entries, ...]:
        """See `Frame`."""
        found = matrix.tocoo()
        in_x = found.row % 2 == 0
        i, j, value = found.row[in_x], found.col[in_x], found.data[in_x]
        forward = Entries(i // 2, j // 2, np.where(j % 2 == 0, value, -1j * value))
        return forward, forward._replace(value=forward.value.conj())

    def systems(self, matrix: SparseArray) -> tuple[SparseArray, SparseArray]:
        """Return the matrices (n, m) of the forward and the backward circle."""
        shape = matrix.shape[0] // 2, matrix.shape[1] // 2
        forward, _ = self.entries(matrix)
        whole = csr_array((forward.value, (forward.row, forward.column)), shape)
        return whole, whole.conj()

    def split(self, vector: ComplexArray) -> ComplexArray:
        """See `Frame`."""
        x, iy = vector[..., 0::2], 1j * vector[..., 1::2]
        return np.stack([x + iy, x - iy], axis=-2) / 2.0

    def join(self, vectors: NumberArray) -> ComplexArray:
        """See `Frame`."""
        *outer, systems, n = vectors.shape
        flat = np.ascontiguousarray(vectors, complex).reshape(math.prod(outer), systems, n)
        return _joined(flat).reshape(*outer, 2 * n)

    def join_matrices(self, matrices: NumberArray) -> ComplexArray:
        """See `Frame`."""
        *outer, systems, n, _ = matrices.shape
        flat = np.ascontiguousarray(matrices, complex).reshape(math.prod(outer), systems, n, n)
        joined = _joined_matrices(flat)
        return joined.reshape(*outer, 2 * n, 2 * n)


@kernel("complex128[:, :, ::1](complex128[:, :, :, ::1])")
def _joined_matrices(systems: ComplexArray) -> ComplexArray:
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


@kernel("complex128[:, ::1](complex128[:, :, ::1])")
def _joined(systems: ComplexArray) -> ComplexArray:
    """Amplitudes (m, 2n) of x, y of those of forward and backward circles (m, 2, n)."""
    m, _, n = systems.shape
    joined = np.empty((m, 2 * n), dtype=np.complex128)
    for k in range(m):
        for i in range(n):
            forward, backward = systems[k, 0, i], systems[k, 1, i]
            joined[k, 2 * i] = forward + backward
            joined[k, 2 * i + 1] = -1j * (forward - backward)
    return joined


@lru_cache(maxsize=8)
def is_axisymmetric(model: RotorModel) -> bool:
    """Tell whether every 2x2 block of a rotor's matrices is [[p, q], [-q, p]].

    The answer is kept, as the same rotor is asked about at every speed.
    """
    return model.size % 2 == 0 and all(_commutes_with_turns(part) for part in model.matrices)


def _commutes_with_turns(matrix: SparseArray) -> bool:
    """Tell whether a matrix is the same, but for rounding, where y is x and -x is y."""
    found = matrix.tocoo()
    i, j, value = found.row, found.col, found.data
    turned = np.where((i + j) % 2 == 0, -value, value)
    places = np.concatenate([i, i ^ 1]), np.concatenate([j, j ^ 1])
    change = csr_array((np.concatenate([value, turned]), places), matrix.shape)
    return bool(np.abs(change.data).max(initial=0.0) <= 1e-14 * np.abs(value).max(initial=0.0))
