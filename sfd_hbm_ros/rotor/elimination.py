"""The shaft's receptance at its ports by elimination, at many frequencies in one call.

The receptance is H = N^T inv(P11) [N, f] for unit forces at the ports and for the linear forces
f. P11 = A_0 + c_1 A_1 + c_2 A_2 + c_3 A_3; with Y = N^T inv(P11) and a dash for the derivative by
whatever the c vary with,

    H = Y [N, f],    H' = Z [N, f],    Z = -Y P11' inv(P11),

so that one banded factorisation of P11, transposed, serves values and derivatives alike.
"""

from typing import Any

import numpy as np

from sfd_hbm_ros.kernels import kernel, part
from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, RealArray


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
def _set(band: Any, shaft: Any, c: Any) -> None:
    """Set P11, transposed, with no fill-in yet."""
    width = shaft.shape[2]
    for i in range(shaft.shape[1]):
        for j in range(width):
            varying = c[0] * shaft[1, i, j] + c[1] * shaft[2, i, j] + c[2] * shaft[3, i, j]
            band[i, j] = shaft[0, i, j] + varying
        band[i, width:] = 0.0


@part
def _minus_product(z: Any, y: Any, shaft: Any, change: Any, half: int) -> None:
    """Set z = -y P11'."""
    n = len(y)
    for i in range(n):
        z[i] = 0.0
        for j in range(max(0, i - half), min(n, i + half + 1)):
            k = j - i + half
            entry = change[0] * shaft[1, i, k] + change[1] * shaft[2, i, k]
            z[i] -= (entry + change[2] * shaft[3, i, k]) * y[j]


@part
def _pick(result: Any, row: Any, ports: Any, forces: Any) -> None:
    """Set a row of H from one of Y, or of H' from one of Z."""
    for column in range(len(ports)):
        result[column] = row[ports[column]]
    for force in range(len(forces)):
        total = 0.0 * row[0]
        for i in range(len(row)):
            total += row[i] * forces[force, i]
        result[len(ports) + force] = total


@kernel(
    "Tuple((complex128[:, :, :, :, ::1], int64))(complex128[:, :, :, ::1], int64[::1],"
    " complex128[:, :, ::1], float64[:, :, ::1])"
)
def eliminate(
    shaft: ComplexArray, ports: IndexArray, forces: ComplexArray, coefficients: RealArray
) -> tuple[ComplexArray, int]:
    """Return the receptance of s systems for m sets of coefficients, and its derivative.

    Parameters
    ----------
    shaft, ports, forces
        `shaft`, `ports` and `shaft_force` of a `Partition`.
    coefficients : (2, m, 3) array
        The c of each set, then their derivatives.

    Returns
    -------
    H and H' (2, m, s, p, p + 2), and the index of the first set whose P11 is singular, or -1.
    """
    systems, _, n, width = shaft.shape
    half, p, m = width // 2, len(ports), coefficients.shape[1]
    receptance = np.empty((2, m, systems, p, p + 2), dtype=np.complex128)
    band, pivots = np.empty((n, 3 * half + 1), dtype=np.complex128), np.empty(n, dtype=np.int64)
    y, z = np.empty(n, dtype=np.complex128), np.empty(n, dtype=np.complex128)
    for i in range(m):
        for k in range(systems):
            _set(band, shaft[k], coefficients[0, i])
            if not _factorise(band, pivots, half):
                return receptance, i
            for row in range(p):
                y[:] = 0.0
                y[ports[row]] = 1.0
                _solve(band, pivots, half, y)
                _pick(receptance[0, i, k, row], y, ports, forces[k])
                _minus_product(z, y, shaft[k], coefficients[1, i], half)
                _solve(band, pivots, half, z)
                _pick(receptance[1, i, k, row], z, ports, forces[k])
    return receptance, -1
