"""The harmonics of a periodic motion and its way between coefficients and time (Eq. 2)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Harmonics:
    """Orders 0..k of the rotor speed, sampled over one revolution.

    Coefficients are real arrays (2k + 1, n): a row for the mean, then for each order a row of
    cosines and one of sines. Complex amplitudes Q of q(t) = Re(Q exp(i w t)) are arrays
    (k + 1, n), Q = Xc - i Xs.

    Parameters
    ----------
    highest : int
        The highest order k, at least 1.
    samples : int, optional
        Time samples a revolution, at least 2k + 1. By default the least power of two from 64 on
        that gives 16 samples to the highest order: the film's spectrum reaches beyond it.

    Raises
    ------
    ValueError
        If a number is out of its range.
    """

    highest: int
    samples: int = 0

    def __post_init__(self) -> None:
        if self.highest < 1:
            raise ValueError(f"harmonics: {self.highest} is not allowed, it must be at least 1")
        if self.samples == 0:
            object.__setattr__(self, "samples", max(64, 1 << (16 * self.highest - 1).bit_length()))
        if self.samples < 2 * self.highest + 1:
            raise ValueError(
                f"samples: {self.samples} is not allowed, {self.highest} harmonics need at least "
                f"{2 * self.highest + 1} a revolution"
            )

    @cached_property
    def orders(self) -> NDArray[np.intp]:
        """Orders 0..k, (k + 1,)."""
        return np.arange(self.highest + 1)

    @property
    def rows(self) -> int:
        """Number of coefficients of one coordinate, 2k + 1."""
        return 2 * self.highest + 1

    def basis_at(self, angle: Array, derivative: int = 0) -> Array:
        """Values at rotor angles [rad] of the cosines and sines that the rows multiply.

        Returns
        -------
        (len(angle), rows) array; with `derivative`, of their derivatives by the angle.
        """
        orders = self.orders[1:]
        shifted = np.multiply.outer(angle, orders) + 0.5 * np.pi * derivative
        basis = np.empty((len(angle), self.rows))
        basis[:, 0] = 1.0 if derivative == 0 else 0.0
        basis[:, 1::2] = orders**derivative * np.cos(shifted)
        basis[:, 2::2] = orders**derivative * np.sin(shifted)
        return basis

    @cached_property
    def bases(self) -> tuple[Array, Array, Array]:
        """Basis at the time samples and its first and second derivative, (samples, rows) each."""
        angle = 2.0 * np.pi * np.arange(self.samples) / self.samples
        return self.basis_at(angle), self.basis_at(angle, 1), self.basis_at(angle, 2)

    @cached_property
    def projection(self) -> Array:
        """Matrix (rows, samples) from time samples to coefficients."""
        projection: Array = self.bases[0].T * (2.0 / self.samples)
        projection[0] *= 0.5
        return projection

    def amplitudes(self, coefficients: Array) -> ComplexArray:
        """Complex amplitudes (k + 1, n) of coefficients (2k + 1, n)."""
        q = np.empty((self.highest + 1, coefficients.shape[1]), dtype=complex)
        q[0] = coefficients[0]
        q[1:] = coefficients[1::2] - 1j * coefficients[2::2]
        return q

    def coefficients(self, amplitudes: ComplexArray) -> Array:
        """Coefficients (2k + 1, n) of complex amplitudes (k + 1, n)."""
        x = np.empty((self.rows, amplitudes.shape[1]))
        x[0] = amplitudes[0].real
        x[1::2] = amplitudes[1:].real
        x[2::2] = -amplitudes[1:].imag
        return x

    def change_from(self, other: "Harmonics", coefficients: Array) -> Array:
        """Coefficients of another set of harmonics, cut off or filled with zeros to this one."""
        x = np.zeros((self.rows, coefficients.shape[1]))
        common = min(self.rows, other.rows)
        x[:common] = coefficients[:common]
        return x

    def real_matrix(self, blocks: ComplexArray) -> Array:
        """Real matrix over coefficients of complex blocks over amplitudes.

        Parameters
        ----------
        blocks : (k + 1, n, n) complex array
            One matrix an order; that of order 0 must be real.

        Returns
        -------
        (rows, n, rows, n) array, zero between different orders.
        """
        n = blocks.shape[1]
        matrix = np.zeros((self.rows, n, self.rows, n))
        matrix[0, :, 0, :] = blocks[0].real
        cos, sin = np.arange(1, self.rows, 2), np.arange(2, self.rows, 2)
        matrix[cos, :, cos, :] = matrix[sin, :, sin, :] = blocks[1:].real
        matrix[cos, :, sin, :] = blocks[1:].imag
        matrix[sin, :, cos, :] = -blocks[1:].imag
        return matrix
