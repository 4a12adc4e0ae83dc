"""Elimination of the shaft from P q = f, Eqs. 9 to 11, for many frequencies in one call.

All matrices are pencils A = A_0 + c_1 A_1 + c_2 A_2 + c_3 A_3, of which every set of coefficients
c gives one member. With Y = P21 inv(P11) and a dash for the derivative by whatever c varies with,

    U  = P22 - Y P12,                V  = F2 - Y F1,
    U' = P22' - Y P12' - Z P12,      V' = F2' - Y F1' - Z F1,      Z = (P21' - Y P11') inv(P11),

so that one banded factorisation of P11, transposed, serves values and derivatives alike.
"""

from typing import Any

import numpy as np

from sfd_hbm_ros.kernels import kernel, part
from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray

_RESULT = "Tuple((complex128[:, :, :, :, ::1], complex128[:, :, :, ::1], int64))"
_PENCILS = ", ".join(["complex128[:, :, :, ::1]"] * 4)
_FORCES = "complex128[:, :, ::1], complex128[:, :, ::1]"
_COEFFICIENTS = ", ".join(["float64[:, :, ::1]"] * 2)
_SIGNATURE = f"{_RESULT}({_PENCILS}, {_FORCES}, {_COEFFICIENTS})"


@part
def _factorise(band: Any, pivots: Any, half: int) -> bool:
    """LU decomposition with partial pivoting in place; whether no pivot is zero.

    The diagonal gets the inverse pivots.

    Parameters
    ----------
    band : (n, 3 half + 1) array
        Entry (i, j) stands at [i, j - i + half]; the last columns are room for fill-in.
    pivots : (n,) integer array
        Gets the row that each row changed places with.
    half : int
        Half bandwidth.
    """
    n = len(band)
    for k in range(n):
        last = min(n, k + half + 1)
        pivot, largest = k, 0.0
        for i in range(k, last):
            entry = band[i, k - i + half]
            size = abs(entry.real) + abs(entry.imag)
            if size > largest:
                pivot, largest = i, size
        pivots[k] = pivot
        if largest == 0.0:
            return False
        end = min(n, k + 2 * half + 1)
        if pivot != k:
            for j in range(k, end):
                one, other = j - k + half, j - pivot + half
                band[k, one], band[pivot, other] = band[pivot, other], band[k, one]
        inverse = band[k, half] = 1.0 / band[k, half]
        for i in range(k + 1, last):
            shift = half - i
            factor = band[i, k + shift] * inverse
            band[i, k + shift] = factor
            if factor != 0.0:
                for j in range(k + 1, end):
                    band[i, j + shift] -= factor * band[k, j - k + half]
    return True


@part
def _solve(band: Any, pivots: Any, half: int, x: Any) -> None:
    """Solve in place for the right-hand side x (n,), after `_factorise`."""
    n = len(band)
    for k in range(n):
        value = x[pivots[k]]
        x[pivots[k]] = x[k]
        x[k] = value
        if value != 0.0:
            for i in range(k + 1, min(n, k + half + 1)):
                x[i] -= band[i, k - i + half] * value
    for k in range(n - 1, -1, -1):
        value = x[k]
        for j in range(k + 1, min(n, k + 2 * half + 1)):
            value -= band[k, j - k + half] * x[j]
        x[k] = value * band[k, half]


@part
def _entry(pencil: Any, c: Any, whole: float, i: int, j: int) -> Any:
    """Entry of A for `whole` = 1, of its derivative for 0."""
    varying = c[0] * pencil[1, i, j] + c[1] * pencil[2, i, j] + c[2] * pencil[3, i, j]
    return whole * pencil[0, i, j] + varying


@part
def _set(total: Any, pencil: Any, c: Any, whole: float) -> None:
    """Set A or its derivative."""
    for i in range(pencil.shape[1]):
        for j in range(pencil.shape[2]):
            total[i, j] = _entry(pencil, c, whole, i, j)


@part
def _subtract_bands(z: Any, y: Any, pencil: Any, c: Any, half: int) -> None:
    """Subtract Y P11' from Z."""
    n = pencil.shape[1]
    for i in range(n):
        for j in range(max(0, i - half), min(n, i + half + 1)):
            entry = _entry(pencil, c, 0.0, i, j - i + half)
            for row in range(len(y)):
                z[row, i] -= entry * y[row, j]


@part
def _subtract_product(result: Any, y: Any, pencil: Any, c: Any, whole: float) -> None:
    """Subtract Y P12, or with `whole` = 0 Y P12', from a matrix."""
    for column in range(pencil.shape[1]):
        for i in range(pencil.shape[2]):
            entry = _entry(pencil, c, whole, column, i)
            for row in range(len(y)):
                result[row, column] -= y[row, i] * entry


@part
def _subtract_force(result: Any, y: Any, forces: Any, factors: Any) -> None:
    """Subtract Y F1 from a vector."""
    for k in range(len(forces)):
        if factors[k] != 0.0:
            for row in range(len(y)):
                for i in range(y.shape[1]):
                    result[row] -= factors[k] * y[row, i] * forces[k, i]


@kernel(_SIGNATURE)
def condense(
    p11: ComplexArray,
    p12: ComplexArray,
    p21: ComplexArray,
    p22: ComplexArray,
    f1: ComplexArray,
    f2: ComplexArray,
    coefficients: RealArray,
    factors: RealArray,
) -> tuple[ComplexArray, ComplexArray, int]:
    """Condense s systems of equations to d coordinates each, for m sets of coefficients.

    Parameters
    ----------
    p11 : (s, 4, n, 2 half + 1) complex array
        Pencils of P11 transposed; entry (i, j) stands at [i, j - i + half].
    p12, p21 : (s, 4, d, n) complex arrays
        Pencils of P12 transposed and of P21.
    p22 : (s, 4, d, d) complex array
        Pencils of P22.
    f1, f2 : (s, 2, n), (s, 2, d) complex arrays
        Forces, to be multiplied by their factors and summed.
    coefficients, factors : (2, m, 3), (2, m, 2) arrays
        The pencils' coefficients and the forces' factors, then their derivatives.

    Returns
    -------
    U and U' (2, m, s, d, d), V and V' (2, m, s, d), and the index of the first set of coefficients
    whose P11 is singular, or -1.
    """
    systems, _, d, n = p12.shape
    half = p11.shape[3] // 2
    m = coefficients.shape[1]
    u = np.empty((2, m, systems, d, d), dtype=np.complex128)
    v = np.zeros((2, m, systems, d), dtype=np.complex128)
    band, pivots = np.empty((n, 3 * half + 1), dtype=p11.dtype), np.empty(n, dtype=np.int64)
    y, z = np.empty((d, n), dtype=p11.dtype), np.empty((d, n), dtype=p11.dtype)
    for i in range(m):
        c, change = coefficients[0, i], coefficients[1, i]
        for k in range(systems):
            band.fill(0.0)
            _set(band, p11[k], c, 1.0)
            if not _factorise(band, pivots, half):
                return u, v, i
            _set(y, p21[k], c, 1.0)
            for row in range(d):
                _solve(band, pivots, half, y[row])
            _set(z, p21[k], change, 0.0)
            _subtract_bands(z, y, p11[k], change, half)
            for row in range(d):
                _solve(band, pivots, half, z[row])
            _set(u[0, i, k], p22[k], c, 1.0)
            _subtract_product(u[0, i, k], y, p12[k], c, 1.0)
            _set(u[1, i, k], p22[k], change, 0.0)
            _subtract_product(u[1, i, k], y, p12[k], change, 0.0)
            _subtract_product(u[1, i, k], z, p12[k], c, 1.0)
            for order in range(2):
                for row in range(d):
                    for force in range(2):
                        v[order, i, k, row] += factors[order, i, force] * f2[k, force, row]
                _subtract_force(v[order, i, k], y, f1[k], factors[order, i])
            _subtract_force(v[1, i, k], z, f1[k], factors[0, i])
    return u, v, -1
