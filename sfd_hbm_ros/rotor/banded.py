"""Banded matrices, one or many, stored as (..., n, 2 half + 1) arrays.

Entry A[i, j] is at [j, half + i - j]: columns one after another, as LAPACK and SciPy's `dia_array`
have them.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import zgbtrf, zgbtrs
from scipy.sparse import dia_array

from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, NumberArray


class SingularSystemError(ArithmeticError):
    """A system is singular; `index` is its place among those solved at once."""

    def __init__(self, index: int) -> None:
        super().__init__(f"system {index} is singular")
        self.index = index


def adjoint(bands: NumberArray) -> NumberArray:
    """Return the conjugate transpose."""
    n, half = bands.shape[-2], bands.shape[-1] // 2
    result = np.zeros_like(bands)
    for offset in range(-half, half + 1):
        j = np.arange(max(0, -offset), n - max(0, offset))
        result[..., j, half + offset] = bands[..., j + offset, half - offset].conj()
    return result


def within(bands: NumberArray, places: IndexArray) -> NumberArray:
    """Return the rows and columns at some places (p,) as full matrices (..., p, p)."""
    half = bands.shape[-1] // 2
    offset = places[:, np.newaxis] - places
    entries = bands[..., places, np.clip(half + offset, 0, 2 * half)]
    return np.asarray(np.where(np.abs(offset) <= half, entries, 0.0))


def as_sparse(bands: NumberArray) -> dia_array:
    """Return one matrix (n, 2 half + 1) for products."""
    n, half = len(bands), bands.shape[1] // 2
    return dia_array((bands.T[::-1], np.arange(-half, half + 1)), shape=(n, n))


def transposed_product(bands: NumberArray, vectors: NumberArray) -> NumberArray:
    """Return A^T x for vectors x (..., n, columns)."""
    n, width = bands.shape[-2:]
    beyond = [(0, 0)] * (vectors.ndim - 2) + [(width // 2, width // 2), (0, 0)]
    padded = np.pad(vectors, beyond)
    product = np.zeros(vectors.shape, dtype=np.result_type(bands, vectors))
    for diagonal in range(width):
        product += bands[..., diagonal, np.newaxis] * padded[..., diagonal : diagonal + n, :]
    return product


class Factorised:
    """Several matrices A, decomposed in one call of LAPACK.

    The matrices stand behind one another on the diagonal of one banded matrix. Partial pivoting
    never reaches over from one into the next.

    Parameters
    ----------
    bands : (..., n, 2 half + 1) array
        The matrices.

    Raises
    ------
    SingularSystemError
        If a pivot is exactly zero.
    """

    def __init__(self, bands: NumberArray) -> None:
        n, width = bands.shape[-2:]
        self._half = width // 2
        if bands.size == 0:
            return
        columns = np.pad(bands.reshape(-1, width), ((0, 0), (self._half, 0)))  # room for fill-in
        self._factors, self._pivots, info = zgbtrf(
            columns.T, self._half, self._half, overwrite_ab=True
        )
        if info > 0:
            raise SingularSystemError((info - 1) // n)

    def solve(self, rhs: NumberArray) -> ComplexArray:
        """Return x of A x = b for right-hand sides b (..., n, columns)."""
        return self._solved(rhs, 0)

    def solve_transposed(self, rhs: NumberArray) -> ComplexArray:
        """Return x of A^T x = b for right-hand sides b (..., n, columns)."""
        return self._solved(rhs, 1)

    def _solved(self, rhs: NumberArray, transposed: int) -> ComplexArray:
        if rhs.size == 0:
            return rhs.astype(complex)
        columns, half = rhs.reshape(-1, rhs.shape[-1]), self._half
        x, _ = zgbtrs(self._factors, half, half, columns, self._pivots, trans=transposed)
        return np.asarray(x).reshape(rhs.shape)
