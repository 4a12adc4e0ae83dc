"""Few vectors in place of all modes of a shaft: the block Lanczos method on its flexibility.

The shaft's dynamic stiffness is P = K - z B, K = L L^H positive definite and B Hermitian. With
A = inv(L) B inv(L)^H and b = inv(L) f, the response at the places of forces f to these forces is
b^H inv(1 - z A) b. In an orthonormal basis V of the space of b, A b, A^2 b, ... it becomes

    b^H V inv(1 - z T) V^H b,    T = V^H A V,

whose eigenvectors are Ritz vectors: exact in as many powers of z as the space has blocks, twice
over, and so at all z when the space is exhausted. With R(z) = b - (1 - z A) V inv(1 - z T) V^H b,
what is left over, and d the least |1 - z m| of all eigenvalues m of A, the response errs by

    |R_i^H inv(1 - z A) R_j| <= |R_i| |R_j| / d.

Modes fall off with the fourth power of their number, and those far above the frequency are taken
together by the first powers of z, so that the number of vectors does not grow with the mesh. See
Bai 2002, Appl. Numer. Math. 43, 9; Golub and Van Loan, Matrix Computations, section 10.3.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.rotor.arrays import NumberArray, RealArray
from sfd_hbm_ros.rotor.flexibility import Flexibility

_ACCURACY = 1e-9  # what may be left over of each force, relative to it; its square counts
_RANK = 1e-13  # relative size below which a direction is one that is there already
_NEW = 0.5  # of a direction, what lies outside the basis, if it is more than rounding
_EVERY = 4  # blocks between two looks at what is left over
_SPEEDS = np.linspace(0.1, 1.0, 10)  # of the highest, at which it is looked at
_NEAREST = 1e-3  # d where it is looked at: closer to a pole rounding decides


class Ritz(NamedTuple):
    """Ritz values m (..., r) of A, and the forces' parts h (..., r, columns) along its vectors.

    The response to the forces, at their places, is h^H diag(1 / (1 - z m)) h.
    """

    values: RealArray
    loads: NumberArray


def ritz(
    flexibility: Flexibility,
    inertia: Callable[[NumberArray], NumberArray],
    forces: NumberArray,
    speed: float,
) -> Ritz:
    """Return as many Ritz vectors as the responses need at all z up to the square of a speed.

    Parameters
    ----------
    flexibility : Flexibility
        Of the stiffness K.
    inertia : callable
        Product of m matrices B with blocks (m, n, columns).
    forces : (m, n, columns) array
        The forces f on each of m shafts with this stiffness.
    speed : float
        Highest square root of z.

    Returns
    -------
    Ritz
        Values (m, r) and loads (m, r, columns).
    """
    start = flexibility.down(forces)
    sizes = np.linalg.norm(start, axis=1, keepdims=True)
    space = _Space(start / np.where(sizes > 0.0, sizes, 1.0))
    for _ in range(start.shape[1]):  # every block has a new direction of those that there are
        if not space.grow():
            break
        space.extend(flexibility.down(inertia(flexibility.up(space.latest))))
        if space.blocks % _EVERY == 0 and space.left_over(speed) <= _ACCURACY:
            break
    values, loads, _ = space.eigenvalues()
    return Ritz(values, loads * sizes)


class _Space:
    """For each of m shafts the space of a block b, A b, A^2 b, ... with its basis V and T.

    Parameters
    ----------
    start : (m, n, columns) array
        The blocks b, of columns of unit length or zero.
    """

    def __init__(self, start: NumberArray) -> None:
        self._start = self._next = start
        self._scale = np.linalg.norm(start, axis=(1, 2))
        self._basis = self.latest = start[..., :0]
        self._columns: list[NumberArray] = []  # of T, down to its diagonal

    @property
    def blocks(self) -> int:
        """Number of blocks in the space."""
        return len(self._columns)

    def grow(self) -> bool:
        """Add the next block's new directions to the basis, and tell whether there are any.

        Zeros stand for directions that are there already; they take no part in anything.

        A direction that is short beside the block that it comes from is at right angles to the
        basis only as far as the rounding of that block lets it be. It is therefore freed of the
        basis once more at its full length. Else a space that is exhausted would find in rounding
        directions that it has, for ever.
        """
        candidates = _directions(self._next, _RANK * self._scale)
        outside = candidates - self._basis @ (self._basis.conj().swapaxes(1, 2) @ candidates)
        latest = _directions(outside, np.full(len(outside), _NEW))
        if not latest.any():
            return False
        self.latest = latest[..., latest.any(axis=(0, 1))]
        self._basis = np.concatenate([self._basis, self.latest], axis=2)
        return True

    def extend(self, image: NumberArray) -> None:
        """Take the latest block's image by A; its part outside the space is the next block."""
        adjoint = self._basis.conj().swapaxes(1, 2)
        inside = adjoint @ image
        outside = image - self._basis @ inside
        rounding = adjoint @ outside
        self._next = outside - self._basis @ rounding
        self._scale = np.linalg.norm(image, axis=(1, 2))
        self._columns.append(inside + rounding)

    def eigenvalues(self) -> tuple[RealArray, NumberArray, NumberArray]:
        """Return those of T, (m, r), and b and the latest block along its eigenvectors."""
        size = self._basis.shape[2]
        T = np.zeros((len(self._start), size, size), dtype=self._basis.dtype)
        end = 0
        for columns in self._columns:
            begin, end = end, end + columns.shape[2]
            T[:, :end, begin:end] = columns
        values, vectors = np.linalg.eigh(T, UPLO="U")
        first = self._columns[0].shape[2]  # the start lies in the first block alone
        start = self._basis[..., :first].conj().swapaxes(1, 2) @ self._start
        loads = vectors[:, :first].conj().swapaxes(1, 2) @ start
        return values, loads, vectors[:, -self.latest.shape[2] :]

    def left_over(self, speed: float) -> float:
        """Return the largest |R| at speeds up to the highest.

        As A V = V T but for the next block, R is z times that and the latest block's share in the
        solution.
        """
        values, loads, latest = self.eigenvalues()
        share = np.linalg.qr(self._next, mode="r") @ latest
        z = np.square(_SPEEDS * speed)[:, np.newaxis, np.newaxis, np.newaxis]
        gaps = 1.0 - z * values[:, np.newaxis]
        gaps = np.where(np.abs(gaps) < _NEAREST, _NEAREST, gaps)
        return float(np.linalg.norm((share * (z / gaps)) @ loads, axis=2).max())


def _directions(vectors: NumberArray, shortest: RealArray) -> NumberArray:
    """Return an orthonormal basis (m, n, r) of m blocks but for what is as short as that, (m,).

    Zeros stand for what was left out.
    """
    directions, lengths, _ = np.linalg.svd(vectors, full_matrices=False)
    long = lengths > shortest[:, np.newaxis]
    return np.asarray(directions * long[:, np.newaxis])
