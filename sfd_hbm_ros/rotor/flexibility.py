"""The static flexibility of a shaft, inv(K) = inv(L)^H inv(L)."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cholesky_banded
from scipy.linalg.lapack import dtbtrs, ztbtrs

from sfd_hbm_ros.rotor.arrays import NumberArray
from sfd_hbm_ros.rotor.banded import adjoint


class Flexibility:
    """Factorised stiffness of a shaft.

    Parameters
    ----------
    stiffness : (n, 2 half + 1) array
        K, stored as `sfd_hbm_ros.rotor.banded` has it, of which the Hermitian part counts.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the stiffness is not positive definite: nothing holds the shaft.
    """

    def __init__(self, stiffness: NumberArray) -> None:
        hermitian = 0.5 * (stiffness + adjoint(stiffness))
        lower = hermitian[:, hermitian.shape[1] // 2 :].T
        self._factor = cholesky_banded(lower, lower=True)

    def down(self, forces: NumberArray) -> NumberArray:
        """Return inv(L) f for forces (m, n, columns)."""
        return self._solve(forces, "N")

    def up(self, vectors: NumberArray) -> NumberArray:
        """Return inv(L)^H v for vectors (m, n, columns)."""
        return self._solve(vectors, "C")

    def _solve(self, rhs: NumberArray, trans: str) -> NumberArray:
        real = np.isrealobj(self._factor) and np.isrealobj(rhs)
        x, _ = (dtbtrs if real else ztbtrs)(self._factor, beside(rhs), uplo="L", trans=trans)
        return apart(x, len(rhs))


def beside(vectors: NumberArray) -> NumberArray:
    """Return several blocks (m, n, columns) beside one another, (n, m columns)."""
    return vectors.transpose(1, 0, 2).reshape(vectors.shape[1], -1)


def apart(columns: NumberArray, number: int) -> NumberArray:
    """Undo `beside` for a number m of blocks."""
    return columns.reshape(len(columns), number, -1).transpose(1, 0, 2)
