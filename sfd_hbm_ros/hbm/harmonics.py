"""The harmonics of a periodic motion and its way between coefficients and time (Eq. 2)."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.jacobian import block_diagonal
from sfd_hbm_ros.hbm.options import OptionError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MAX_MULTIPLES = 400
"""Films excite none so high, and the work grows with the third power of their number."""

MAX_SAMPLES = 16_384
"""Of a period, twice as many as the most harmonics need: their bases fill the memory."""


@dataclass(frozen=True)
class Harmonics:
    """Orders of the rotor speed, sampled over one period of one or more revolutions.

    Coefficients are real arrays (rows, n): a row for the mean, then for each order a row of
    cosines and one of sines. Complex amplitudes Q of q(t) = Re(Q exp(i w t)) are arrays
    (orders, n), Q = Xc - i Xs.

    Parameters
    ----------
    highest : int
        The highest order k of the speed, at least 1; times `revolutions` at most
        MAX_MULTIPLES.
    samples : int, optional
        Time samples a period. By default the least power of two from 64 on that gives 16 to the
        highest order, for each revolution: the film's spectrum reaches beyond it. At most
        MAX_SAMPLES.
    revolutions : int, optional
        Revolutions of the rotor in a period: 2 or 3 for sub-harmonics of a half or a third.
    multiples : tuple of int, optional
        The orders times `revolutions`, rising from 0; by default all up to the highest.

    Raises
    ------
    OptionError
        If a number is out of its range.
    """

    highest: int
    samples: int = 0
    revolutions: int = 1
    multiples: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.highest < 1:
            raise OptionError(f"harmonics: {self.highest} is not allowed, it must be at least 1")
        if self.revolutions < 1:
            raise OptionError(
                f"revolutions: {self.revolutions} is not allowed, it must be at least 1"
            )
        most = self.highest * self.revolutions
        if most > MAX_MULTIPLES:
            times = f" times {self.revolutions} revolutions" if self.revolutions > 1 else ""
            raise OptionError(
                f"harmonics: {self.highest}{times} are not allowed, they must be {MAX_MULTIPLES} "
                "at most"
            )
        multiples = self.multiples or tuple(range(most + 1))
        revolution = max(64, 1 << (16 * self.highest - 1).bit_length())
        samples = self.samples or self.revolutions * revolution
        object.__setattr__(self, "multiples", multiples)
        object.__setattr__(self, "samples", samples)
        if multiples[0] != 0 or multiples[-1] > most or np.any(np.diff(multiples) <= 0):
            raise OptionError(
                f"multiples: {multiples} is not allowed, they must rise from 0 to {most} at most"
            )
        if samples > MAX_SAMPLES:
            raise OptionError(
                f"samples: {samples} is not allowed, a period must have at most {MAX_SAMPLES}"
            )
        if samples < 2 * most + 1:
            raise OptionError(
                f"samples: {samples} is not allowed, {self.highest} harmonics need at least "
                f"{2 * most + 1} a period"
            )

    @cached_property
    def orders(self) -> NDArray[np.inexact[Any]] | NDArray[np.intp]:
        """Orders of the speed, (orders,): whole numbers where a period is one revolution."""
        return self.indices if self.revolutions == 1 else self.indices / self.revolutions

    @cached_property
    def indices(self) -> NDArray[np.int64]:
        """The multiples as an array, (orders,)."""
        return np.array(self.multiples)

    def only(self, multiples: tuple[int, ...]) -> "Harmonics":
        """A group of these harmonics, with the same samples."""
        return Harmonics(self.highest, self.samples, self.revolutions, multiples)

    @property
    def rows(self) -> int:
        """Number of coefficients of one coordinate: one of the mean, two of each other order."""
        return 2 * len(self.multiples) - 1

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

    def bases_over(self, points: int) -> tuple[Array, Array, Array]:
        """Basis at even angles over a period and its first and second derivative, kept."""
        return _bases_over(self, points)

    def angles(self, points: int) -> Array:
        """Rotor angles [rad] evenly spaced over a period, (points,)."""
        return 2.0 * np.pi * self.revolutions * np.arange(points) / points

    @cached_property
    def bases(self) -> tuple[Array, Array, Array]:
        """Basis at the time samples and its first and second derivative, (samples, rows) each."""
        return self.bases_over(self.samples)

    @cached_property
    def fine_basis(self) -> Array:
        """Basis at 512 angles a revolution, at which orbits are searched for their extremes."""
        return self.basis_at(self.angles(512 * self.revolutions))

    @cached_property
    def projection(self) -> Array:
        """Matrix (rows, samples) from time samples to coefficients."""
        projection: Array = self.bases[0].T * (2.0 / self.samples)
        projection[0] *= 0.5
        return projection

    @cached_property
    def spectrum(self) -> Array:
        """Means of samples times cos(k t) and times sin(k t), k up to twice the highest multiple.

        t is the angle of the period.

        Returns
        -------
        (2 m, samples) array, m rows of cosines first.
        """
        orders = np.arange(2 * self.multiples[-1] + 1)
        angle = np.multiply.outer(orders, 2.0 * np.pi * np.arange(self.samples) / self.samples)
        return np.concatenate([np.cos(angle), np.sin(angle)]) / self.samples

    def amplitudes(self, coefficients: Array) -> ComplexArray:
        """Complex amplitudes (orders, n) of coefficients (rows, n)."""
        q = np.empty((len(self.multiples), coefficients.shape[1]), dtype=complex)
        q[0] = coefficients[0]
        q[1:] = coefficients[1::2] - 1j * coefficients[2::2]
        return q

    def coefficients(self, amplitudes: ComplexArray) -> Array:
        """Coefficients (rows, n) of complex amplitudes (orders, n)."""
        x = np.empty((self.rows, amplitudes.shape[1]))
        x[0] = amplitudes[0].real
        x[1::2] = amplitudes[1:].real
        x[2::2] = -amplitudes[1:].imag
        return x

    def change_from(self, other: "Harmonics", coefficients: Array) -> Array:
        """Coefficients of another group of harmonics, cut or filled with zeros to this group."""
        known = {Fraction(m, other.revolutions): i for i, m in enumerate(other.multiples)}
        there = other.amplitudes(coefficients)
        here = np.zeros((len(self.multiples), coefficients.shape[1]), dtype=complex)
        for i, m in enumerate(self.multiples):
            order = Fraction(m, self.revolutions)
            if order in known:
                here[i] = there[known[order]]
        return self.coefficients(here)

    def real_matrix(self, blocks: ComplexArray) -> Array:
        """Real matrix over coefficients of complex blocks over amplitudes.

        Parameters
        ----------
        blocks : (orders, n, n) complex array
            One matrix an order; that of order 0 must be real.

        Returns
        -------
        (rows, n, rows, n) array, zero between different orders.
        """
        return block_diagonal(np.array(blocks, dtype=complex, order="C"))


@lru_cache(maxsize=16)
def _bases_over(harmonics: Harmonics, points: int) -> tuple[Array, Array, Array]:
    angle = harmonics.angles(points)
    return harmonics.basis_at(angle), harmonics.basis_at(angle, 1), harmonics.basis_at(angle, 2)
