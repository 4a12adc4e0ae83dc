"""Condensation of an undamped shaft through its modes, for many speeds W at the same harmonics.

At the frequency k W the shaft's part of the dynamic stiffness is P11 = K - W^2 B with
B = k^2 M - i k G, both Hermitian, and K positive definite where the journals are held by their
ball bearings. With B F = K F diag(m) and F^H K F = 1, the modes of the harmonic k,

    inv(P11) = F diag(1 / (1 - W^2 m)) F^H

at every speed. This is exact, as all modes are kept, and smooth where elimination would round
differently at every speed; the modes cost as much as some fifty eliminations.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from sfd_hbm_ros.kernels import kernel
from sfd_hbm_ros.rotor.arrays import ComplexArray, NumberArray, RealArray

_WORTHWHILE = 20  # uses in a row after which modes pay
_MOST = 400  # coordinates beyond which they cost too much, as the cube of them


@kernel(
    "Tuple((complex128[:, :, :, :, ::1], complex128[:, :, :, ::1], int64))"
    "(float64, float64[:, :, ::1], complex128[:, :, :, ::1], complex128[:, :, :, ::1],"
    " complex128[:, :, :, ::1], complex128[:, :, ::1], float64[:, :, ::1], float64[:, :, ::1])"
)
def _condense(
    speed: float,
    squares: RealArray,
    left: ComplexArray,
    right: ComplexArray,
    p22: ComplexArray,
    f2: ComplexArray,
    c: RealArray,
    factors: RealArray,
) -> tuple[ComplexArray, ComplexArray, int]:
    """U, U', V, V' as `elimination.condense` has them, and the index of a harmonic on a mode."""
    m, systems, d, n = left.shape
    u = np.empty((2, m, systems, d, d), dtype=np.complex128)
    v = np.empty((2, m, systems, d), dtype=np.complex128)
    sums = np.empty((2, d + 2), dtype=np.complex128)
    for k in range(m):
        for s in range(systems):
            for i in range(d):
                sums[:] = 0.0
                for mode in range(n):
                    gap = 1.0 - speed * speed * squares[k, s, mode]
                    if gap == 0.0:
                        return u, v, k
                    value = left[k, s, i, mode] / gap
                    slope = value * (2.0 * speed * squares[k, s, mode] / gap)
                    for j in range(d + 2):
                        sums[0, j] += value * right[k, s, j, mode]
                        sums[1, j] += slope * right[k, s, j, mode]
                for j in range(d):
                    a = p22[:, s, i, j]
                    for order in range(2):
                        by = c[order, k, 0] * a[1] + c[order, k, 1] * a[2] + c[order, k, 2] * a[3]
                        u[order, k, s, i, j] = by - sums[order, j]
                    u[0, k, s, i, j] += a[0]
                static, unbalance = f2[0, s, i] - sums[0, d], f2[1, s, i] - sums[0, d + 1]
                for order in range(2):
                    v[order, k, s, i] = static * factors[order, k, 0]
                    v[order, k, s, i] += unbalance * factors[order, k, 1]
                v[1, k, s, i] -= sums[1, d] * factors[0, k, 0] + sums[1, d + 1] * factors[0, k, 1]
    return u, v, -1


class ShaftModes:
    """Modes of the shaft with the journals held, for each of m harmonics of s systems.

    Parameters
    ----------
    terms : (4, s, N, N) array
        K, i C, i G and M of the whole rotor.
    forces : (2, s, N) complex array
        Forces on it.
    shaft : int
        Number n of the shaft's coordinates, which come first.
    orders : (m,) array
        The harmonics.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the shaft is not held by its bearings, the journals being held.
    """

    def __init__(
        self, terms: NumberArray, forces: ComplexArray, shaft: int, orders: RealArray
    ) -> None:
        n = shaft
        K, _, iG, M = terms[..., :n, :n]
        left, right, squares = [], [], []
        for k in orders:
            for system in range(terms.shape[1]):
                B = k * k * M[system] - k * iG[system]
                square, modes = eigh(B, K[system])
                there = terms[0, system, n:, :n] @ modes
                back = np.concatenate([terms[0, system, :n, n:], forces[:, system, :n].T], axis=1)
                left.append(there)
                right.append((modes.conj().T @ back).T)
                squares.append(square)
        shape = len(orders), terms.shape[1]
        self._parts = (
            np.array(squares).reshape(*shape, n),
            np.array(left, dtype=complex).reshape(*shape, -1, n),
            np.array(right, dtype=complex).reshape(*shape, -1, n),
            np.array(terms[..., n:, n:], dtype=complex, order="C"),
            np.array(forces[..., n:], order="C"),
        )

    def condense(
        self, speed: float, coefficients: RealArray, factors: RealArray
    ) -> tuple[ComplexArray, ComplexArray, int]:
        """Return what `elimination.condense` does, with derivatives by the speed [rad/s]."""
        return _condense(speed, *self._parts, coefficients, factors)


class KeptModes:
    """The shaft's modes at the harmonics that are asked for again and again, as along a branch.

    Parameters
    ----------
    terms, forces, shaft
        Those of `ShaftModes`.
    """

    def __init__(self, terms: NumberArray, forces: ComplexArray, shaft: int) -> None:
        self._arguments = terms, forces, shaft
        self._exist = shaft <= _MOST and _is_undamped(terms, shaft)
        self._kept: dict[bytes, ShaftModes] = {}
        self._latest, self._uses = b"", 0

    def of(self, orders: RealArray) -> ShaftModes | None:
        """Return the modes at harmonics (m,), or None where they do not exist or pay."""
        key = orders.tobytes()
        if not self._exist or key in self._kept:
            return self._kept.get(key)
        self._uses = self._uses + 1 if key == self._latest else 1
        self._latest = key
        if self._uses < _WORTHWHILE:
            return None
        try:
            self._kept[key] = ShaftModes(*self._arguments, orders)
        except np.linalg.LinAlgError:  # the shaft is free to move: K is singular
            self._exist = False
        return self._kept.get(key)


def _is_undamped(terms: NumberArray, shaft: int) -> bool:
    """Tell whether K is constant and Hermitian and couples shaft and journals by itself."""
    n = shaft
    K, varying = terms[0, :, :n, :n], terms[1:]
    coupled = varying[..., :n, n:].any() or varying[..., n:, :n].any()
    damped = terms[1, :, :n, :n].any()
    skew = np.abs(K - K.conj().swapaxes(1, 2)).max(initial=0.0)
    return bool(not coupled and not damped and skew <= 1e-14 * np.abs(K).max(initial=0.0))
