"""The lowest modes: all of a small rotor, as many as are wanted of a large one.

The matrices are sparse, and ARPACK finds the lowest modes by the inverse, Arnoldi's and Lanczos's
methods: time and memory grow with the number of coordinates, not with its cube.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eig, eigh, eigvals
from scipy.sparse.linalg import LinearOperator, eigs, eigsh

from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray, SparseArray

_SMALL = 500  # rows up to which all eigenvalues are found, sooner than some of them
_FIRST = 16  # modes that are sought first where their number is not known


def largest_eigenpairs(operator: LinearOperator, count: int) -> tuple[ComplexArray, ComplexArray]:
    """Return eigenvalues and eigenvectors, in no order: all, or those of largest magnitude.

    Parameters
    ----------
    operator : LinearOperator
        The matrix (n, n), by its products.
    count : int
        Number of those of a large matrix.

    Returns
    -------
    (m,) array
        Eigenvalues.
    (n, m) array
        Eigenvectors.
    """
    n = operator.shape[0]
    if _is_small(n, count):
        values, vectors = eig(operator @ np.eye(n))
    else:
        values, vectors = eigs(operator, count, v0=_start(n))
    return values, vectors


def largest_eigenvalues(operator: LinearOperator, count: int) -> ComplexArray:
    """Return the eigenvalues alone, sooner; see `largest_eigenpairs`."""
    n = operator.shape[0]
    if _is_small(n, count):
        return np.asarray(eigvals(operator @ np.eye(n)))
    return np.asarray(eigs(operator, count, v0=_start(n), return_eigenvectors=False))


def lowest_modes(
    stiffness: SparseArray, mass: SparseArray, highest_frequency: float
) -> tuple[RealArray, RealArray]:
    """Return the modes up to a natural frequency, in rising order.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse arrays
        Symmetric matrices, of which the mass is positive definite.
    highest_frequency : float
        The highest natural frequency [rad/s].

    Returns
    -------
    (m,) array
        Natural frequencies [rad/s]; 0 for motions that nothing holds.
    (n, m) array
        Modes of unit modal mass.
    """
    n, count = stiffness.shape[0], _FIRST
    highest = highest_frequency**2
    if n <= _SMALL:
        limits = -np.inf, highest
        squares, modes = eigh(stiffness.toarray(), mass.toarray(), subset_by_value=limits)
        return _frequencies(squares), modes
    while True:
        # a little below zero, where no mode is and a shaft that nothing holds has stiffness
        squares, modes = eigsh(stiffness, count, mass, sigma=-1.0, v0=_start(n))
        if squares.max() > highest or 2 * count >= n:
            kept = np.argsort(squares)[: np.count_nonzero(squares <= highest)]
            return _frequencies(squares[kept]), modes[:, kept]
        count *= 2


def _is_small(n: int, count: int) -> bool:
    """Tell whether all eigenvalues are found; ARPACK finds all but two at most."""
    return n <= max(_SMALL, count + 1)


def _start(n: int) -> RealArray:
    """Return a vector that is not orthogonal to any mode, and always the same."""
    return np.random.default_rng(0).standard_normal(n)


def _frequencies(squares: RealArray) -> RealArray:
    return np.sqrt(np.maximum(squares, 0.0))
