"""Matrix pencils A = A_0 + c_1 A_1 + c_2 A_2 + ..., of which many members are wanted at once."""

from __future__ import annotations

import numpy as np
from scipy.linalg import bandwidth
from scipy.linalg.lapack import dgbsv, zgbsv

from sfd_hbm_ros.rotor.arrays import NumberArray, RealArray


class SingularSystemError(ArithmeticError):
    """A system is singular; `index` is that of its set of coefficients."""

    def __init__(self, index: int) -> None:
        super().__init__(f"a system with the coefficients {index} is singular")
        self.index = index


class Pencil:
    """Arrays to be combined.

    Parameters
    ----------
    terms : (1 + terms, ...) array
        A_0, A_1, ..., real or complex.
    """

    def __init__(self, terms: NumberArray) -> None:
        self._shape = terms.shape[1:]
        self._terms = np.ascontiguousarray(terms).reshape(len(terms), -1)

    def combine(self, coefficients: RealArray) -> NumberArray:
        """Return A (m, ...) for coefficients (m, terms)."""
        # A_0 is added after the product: OpenBLAS's complex product can leave the vector unit in a
        # state in which LAPACK runs four times slower, and the addition ends that.
        combined = self._terms[0] + coefficients @ self._terms[1:]
        return np.asarray(combined).reshape(len(coefficients), *self._shape)


class BandedPencil:
    """Banded square matrices to be combined and solved.

    Parameters
    ----------
    terms : (1 + terms, systems, n, n) array
        A_0, A_1, ... of several systems of equations, real or complex.
    """

    def __init__(self, terms: NumberArray) -> None:
        self._half = half_bandwidth(terms)
        self._bands = Pencil(bands(terms, self._half))

    def solve(self, coefficients: RealArray, rhs: NumberArray) -> NumberArray:
        """Solve A x = b for several sets of coefficients and all systems in one call of LAPACK.

        The matrices stand behind one another on the diagonal of one banded matrix. Partial
        pivoting never reaches over from one into the next.

        Parameters
        ----------
        coefficients : (m, terms) array
            The c_k of each set.
        rhs : (m, systems, n, columns) array
            Right-hand sides b, real or complex.

        Returns
        -------
        (m, systems, n, columns) array
            The solutions x, real if all that is given is.

        Raises
        ------
        SingularSystemError
            If a pivot is exactly zero.
        """
        if rhs.size == 0:
            return rhs
        half = self._half
        bands = self._bands.combine(coefficients).reshape(-1, 3 * half + 1).T
        columns = rhs.reshape(-1, rhs.shape[-1])
        gbsv = zgbsv if np.iscomplexobj(bands) or np.iscomplexobj(columns) else dgbsv
        *_, x, info = gbsv(half, half, bands, columns, overwrite_ab=True)
        if info > 0:
            raise SingularSystemError((info - 1) * len(rhs) // len(columns))
        return np.asarray(x).reshape(rhs.shape)


def half_bandwidth(matrices: NumberArray) -> int:
    """Return the least half bandwidth that holds all matrices (..., n, n)."""
    return int(max(bandwidth(np.abs(matrices).reshape(-1, *matrices.shape[-2:]).sum(axis=0))))


def bands(matrices: NumberArray, half: int) -> NumberArray:
    """Return the columns (..., n, 3 half + 1) of LAPACK's band storage, with room for fill-in.

    Entry A[i, j] goes to [j, 2 half + i - j].
    """
    n = matrices.shape[-1]
    bands = np.zeros((*matrices.shape[:-1], 3 * half + 1), dtype=matrices.dtype)
    for offset in range(-half, half + 1):
        j = np.arange(max(0, -offset), n - max(0, offset))
        bands[..., j, 2 * half + offset] = matrices[..., j + offset, j]
    return bands
