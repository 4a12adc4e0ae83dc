"""Real matrices over the coefficients of a motion, from the harmonics of what they multiply.

The derivative of a film's force is, at every time sample, a matrix times the motion and its rates.
In the coefficients a product with a function of time mixes the orders a and b by the function's
spectrum at a - b and a + b: a Toeplitz and a Hankel matrix.
"""

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.kernels import kernel

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@kernel("float64[:, :, :, ::1](complex128[:, :, ::1])")
def block_diagonal(blocks: ComplexArray) -> Array:
    """Real matrix (rows, n, rows, n) of one matrix an order; see `Harmonics.real_matrix`."""
    orders, n, _ = blocks.shape
    matrix = np.zeros((2 * orders - 1, n, 2 * orders - 1, n))
    for i in range(n):
        for j in range(n):
            matrix[0, i, 0, j] = blocks[0, i, j].real
            for k in range(1, orders):
                cos, sin, block = 2 * k - 1, 2 * k, blocks[k, i, j]
                matrix[cos, i, cos, j] = matrix[sin, i, sin, j] = block.real
                matrix[cos, i, sin, j], matrix[sin, i, cos, j] = block.imag, -block.imag
    return matrix


@kernel("(float64[:, :, :, ::1], int64, float64[:, :, :, ::1], int64[::1], float64[::1])")
def subtract_products(
    matrix: Array, first: int, spectra: Array, multiples: NDArray[np.int64], frequencies: Array
) -> None:
    """Subtract what multiplies the coefficients in D0 q + D1 q' + D2 q'', for one journal.

    Parameters
    ----------
    matrix : (rows, n, rows, n) array
        The matrix over the coefficients.
    first : int
        The journal's first coordinate of the n.
    spectra : (3, 2, m, 4) array
        Means of D0, D1 and D2, entry by entry, times cos(k t) and times sin(k t), for k = 0 to at
        least twice the highest multiple.
    multiples : (orders,) integer array
        The orders, as multiples of the frequency of the period.
    frequencies : (orders,) array
        Their frequencies [rad/s].
    """
    c, s = spectra[:, 0], spectra[:, 1]
    for column in range(len(multiples)):
        w = frequencies[column]
        for row in range(len(multiples)):
            weight = 1.0 if row > 0 else 0.5
            total = multiples[row] + multiples[column]
            difference = abs(multiples[row] - multiples[column])
            sign = 1.0 if multiples[row] >= multiples[column] else -1.0
            for entry in range(4):
                i, j = first + entry // 2, first + entry % 2
                # in phase with the motion, and with its rate
                cp = c[0, total, entry] - w * w * c[2, total, entry]
                cm = c[0, difference, entry] - w * w * c[2, difference, entry]
                sp = s[0, total, entry] - w * w * s[2, total, entry]
                sm = sign * (s[0, difference, entry] - w * w * s[2, difference, entry])
                dcp, dcm = w * c[1, total, entry], w * c[1, difference, entry]
                dsp, dsm = w * s[1, total, entry], w * sign * s[1, difference, entry]
                cos_row, cos = max(2 * row - 1, 0), max(2 * column - 1, 0)
                matrix[cos_row, i, cos, j] -= weight * (cm + cp - dsp + dsm)
                if column > 0:
                    matrix[cos_row, i, cos + 1, j] -= weight * (sp - sm + dcm + dcp)
                if row > 0:
                    matrix[cos_row + 1, i, cos, j] -= weight * (sp + sm - dcm + dcp)
                if row > 0 and column > 0:
                    matrix[cos_row + 1, i, cos + 1, j] -= weight * (cm - cp + dsp + dsm)


@kernel(
    "float64[:, ::1](float64[:, :, ::1], float64[:, ::1], float64[:, :, ::1], float64[:, ::1])"
)
def sampled_products(first: Array, x: Array, second: Array, y: Array) -> Array:
    """Sums A x + B y at every sample: (samples, 2) of (samples, 2, 2) and (samples, 2)."""
    total = np.empty((len(x), 2))
    for t in range(len(x)):
        for i in range(2):
            total[t, i] = first[t, i, 0] * x[t, 0] + first[t, i, 1] * x[t, 1]
            total[t, i] += second[t, i, 0] * y[t, 0] + second[t, i, 1] * y[t, 1]
    return total
