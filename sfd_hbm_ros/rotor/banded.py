"""Banded matrices, one or many, stored as (..., n, 2 half + 1) arrays.

Entry A[i, j] is at [j, half + i - j]: columns one after another, as LAPACK and SciPy's `dia_array`
have them.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import zgbsv
from scipy.sparse import dia_array

from sfd_hbm_ros.rotor.arrays import IndexArray, NumberArray


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


def solve(bands: NumberArray, rhs: NumberArray) -> NumberArray:
    """Solve A x = b for several matrices in one call of LAPACK.

    The matrices stand behind one another on the diagonal of one banded matrix. Partial pivoting
    never reaches over from one into the next.

    Parameters
    ----------
    bands : (..., n, 2 half + 1) array
        The matrices A.
    rhs : (..., n) array
        Right-hand sides b.

    Returns
    -------
    (..., n) complex array
        The solutions x.

    Raises
    ------
    SingularSystemError
        If a pivot is exactly zero.
    """
    if rhs.size == 0:
        return rhs
    half = bands.shape[-1] // 2
    columns = np.pad(bands.reshape(rhs.size, -1), ((0, 0), (half, 0)))  # room for fill-in
    *_, x, info = zgbsv(half, half, columns.T, rhs.reshape(-1, 1), overwrite_ab=True)
    if info > 0:
        raise SingularSystemError((info - 1) // rhs.shape[-1])
    return np.asarray(x).reshape(rhs.shape)
