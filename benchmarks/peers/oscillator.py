"""Duffing's oscillator in harmonic balance: q'' + d q' + q + b q^3 = F cos(w t), F = 1.

It is written once, for our continuation and for that of a peer.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Harmonics

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Duffing:
    """The oscillator at any frequency, by alternating frequency and time.

    Parameters
    ----------
    harmonics : Harmonics
        Harmonics of the frequency; their `rows` coefficients are the unknowns.
    damping, cubic : float
        Coefficients d and b.
    largest : float
        Displacement to which the unknowns are compared; the branch ends there.
    """

    harmonics: Harmonics
    damping: float = 0.1
    cubic: float = 0.04
    largest: float = 20.0

    def residual(self, x: Array, w: float) -> Array:
        """Imbalance of the forces, (rows,)."""
        q, velocity, acceleration = self._motion(x, w)
        imbalance = acceleration + self.damping * velocity + q + self.cubic * q**3
        residual: Array = self.harmonics.projection @ imbalance
        residual[1] -= 1.0
        return residual

    def jacobian(self, x: Array, w: float) -> Array:
        """Derivative of the residual by the coefficients, (rows, rows)."""
        e0, e1, e2 = self.harmonics.bases
        stiffness = 1.0 + 3.0 * self.cubic * (e0 @ x) ** 2
        by_coefficients = w * w * e2 + self.damping * w * e1 + stiffness[:, np.newaxis] * e0
        jacobian: Array = self.harmonics.projection @ by_coefficients
        return jacobian

    def slope(self, x: Array, w: float) -> Array:
        """Derivative of the residual by the frequency, (rows,)."""
        _, e1, e2 = self.harmonics.bases
        slope: Array = self.harmonics.projection @ (2.0 * w * (e2 @ x) + self.damping * (e1 @ x))
        return slope

    def linear_response(self, w: float) -> Array:
        """Response without the cubic spring, (rows,): where Newton's method begins."""
        x = np.zeros(self.harmonics.rows)
        amplitude = 1.0 / (1.0 - w * w + 1j * w * self.damping)
        x[1:3] = amplitude.real, -amplitude.imag
        return x

    def at(self, value: float) -> "DuffingEquations":
        """Equations at a frequency, as a `Family` gives them."""
        return DuffingEquations(self, value)

    def _motion(self, x: Array, w: float) -> tuple[Array, Array, Array]:
        e0, e1, e2 = self.harmonics.bases
        return e0 @ x, w * (e1 @ x), w * w * (e2 @ x)


@dataclass(frozen=True)
class DuffingEquations:
    """The oscillator at one frequency, with all that `Branch` and `newton` ask of equations."""

    oscillator: Duffing
    frequency: float

    load = 1.0

    @property
    def scale(self) -> Array:
        """The displacement each unknown is compared to, (rows,)."""
        return np.full(self.oscillator.harmonics.rows, self.oscillator.largest)

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Residual and its derivative by the coefficients."""
        return (
            self.oscillator.residual(x, self.frequency),
            self.oscillator.jacobian(x, self.frequency),
        )

    def rotor_force(self, x: Array) -> Array:
        """Linear part of the forces."""
        linear = Duffing(self.oscillator.harmonics, self.oscillator.damping, cubic=0.0)
        force: Array = linear.jacobian(x, self.frequency) @ x
        return force

    def eccentricity(self, x: Array) -> float:
        """Greatest displacement at the time samples, of the largest."""
        q = self.oscillator.harmonics.bases[0] @ x
        return float(np.abs(q).max() / self.oscillator.largest)

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a step that stays where the equations hold: all of it."""
        return 1.0
