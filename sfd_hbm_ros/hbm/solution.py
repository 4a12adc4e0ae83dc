"""What a harmonic balance solve hands on: the motion of each damper's journal."""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import Motion
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.newton import Outcome

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_ORBIT_POINTS = 512


def greatest_distance(harmonics: Harmonics, coefficients: Array) -> float:
    """Greatest distance of an orbit from the origin [m].

    Parameters
    ----------
    harmonics : Harmonics
        Harmonics of the coefficients.
    coefficients : (rows, 2) array
        Mean, then cosine and sine of each order, of x and y [m].
    """
    squares = np.square(harmonics.fine_basis @ coefficients).sum(axis=1)
    best = int(np.argmax(squares))
    spacing = 2.0 * np.pi * harmonics.revolutions / len(squares)
    orders, amplitudes = harmonics.orders, harmonics.amplitudes(coefficients)
    w = 1j * orders
    rates = np.stack([amplitudes, w[:, None] * amplitudes, (w * w)[:, None] * amplitudes], 1)
    angle, farthest = best * spacing, float(squares[best])
    for _ in range(4):  # Newton's method on the derivative of the squared distance
        turned = np.exp(w * angle) @ rates.reshape(len(orders), -1)
        x, y, x1, y1, x2, y2 = turned.real.tolist()
        farthest = max(farthest, x * x + y * y)
        bend = x1 * x1 + y1 * y1 + x * x2 + y * y2
        if bend >= 0.0:  # a circle about the centre has no maximum to refine
            break
        move = min(max((x * x1 + y * y1) / bend, -spacing), spacing)
        angle -= move
        if abs(move) < 1e-6 * spacing:  # below the rounding of the maximum
            break
    return math.sqrt(farthest)


def greatest_vibration(harmonics: Harmonics, coefficients: Array) -> float:
    """Greatest distance of an orbit from its own mean [m]; parameters as `greatest_distance`."""
    about_mean = coefficients.copy()
    about_mean[0] = 0.0
    return greatest_distance(harmonics, about_mean)


@dataclass(frozen=True, eq=False)
class JournalMotion:
    """Periodic motion of one damper's journal.

    Attributes
    ----------
    name : str
        The damper.
    clearance : float
        Its clearance [m].
    harmonics : Harmonics
        Harmonics of the coefficients.
    coefficients : (rows, 2) array
        Mean, then cosine and sine of each order, of x and y [m] (Eq. 2).
    """

    name: str
    clearance: float
    harmonics: Harmonics
    coefficients: Array

    def __getstate__(self) -> dict[str, Any]:
        """What is sent to another process: what is known but for the samples, which are large."""
        return {name: value for name, value in vars(self).items() if name != "_samples"}

    @property
    def cos(self) -> Array:
        """Mean and cosine coefficients [m], (orders, 2)."""
        return self.harmonics.amplitudes(self.coefficients).real

    @property
    def sin(self) -> Array:
        """Sine coefficients [m], (orders, 2); that of order 0 is zero."""
        return 0.0 - self.harmonics.amplitudes(self.coefficients).imag

    def orbit(self, points: int = _ORBIT_POINTS) -> Array:
        """Positions over one period [m], (points, 2)."""
        return self.at(self.harmonics.angles(points))

    @cached_property
    def _samples(self) -> Array:
        """Positions over one period, finely sampled [m]."""
        samples: Array = self.harmonics.fine_basis @ self.coefficients
        return samples

    @cached_property
    def eccentricity_max(self) -> float:
        """Greatest eccentricity sqrt(x^2 + y^2)/c of the orbit (Eq. 15)."""
        return greatest_distance(self.harmonics, self.coefficients) / self.clearance

    @cached_property
    def vibration(self) -> float:
        """Greatest distance of the orbit from its own mean [m], zero to peak."""
        return greatest_vibration(self.harmonics, self.coefficients)

    @cached_property
    def eccentricity_mean(self) -> float:
        """Eccentricity averaged over the period."""
        return float(np.linalg.norm(self._samples, axis=1).mean()) / self.clearance

    def over(self, points: int, frequency: float) -> Motion:
        """Motion at times evenly spaced over the period.

        Parameters
        ----------
        points : int
            Their number.
        frequency : float
            Frequency of which the harmonics are multiples [rad/s].
        """
        position, rate, second = (
            basis @ self.coefficients for basis in self.harmonics.bases_over(points)
        )
        return position, frequency * rate, frequency**2 * second

    def at(self, angle: Array, derivative: int = 0) -> Array:
        """Positions at rotor angles [rad], or their derivatives by the angle, (len(angle), 2)."""
        return self.harmonics.basis_at(angle, derivative) @ self.coefficients


@dataclass(frozen=True, eq=False)
class Solution:
    """Response of a machine at one speed, or why there is none.

    Attributes
    ----------
    speed : float
        Rotor speed [rad/s].
    harmonics : Harmonics
        Harmonics that were balanced.
    outcome : Outcome
        How the solution ended. Unless it converged, `coefficients` are NaN.
    message : str
        The outcome as a sentence.
    residuals : tuple of float
        History of the residual's norm, relative to the load.
    journals : mapping of str to JournalMotion
        Motion of each damper's journal, by the damper's name.
    """

    speed: float
    harmonics: Harmonics
    outcome: Outcome
    message: str
    residuals: tuple[float, ...]
    journals: dict[str, JournalMotion]

    @property
    def converged(self) -> bool:
        """Whether this is a solution."""
        return self.outcome.converged

    @property
    def eccentricity_max(self) -> float:
        """Greatest eccentricity of any damper."""
        return max(motion.eccentricity_max for motion in self.journals.values())

    @property
    def residual(self) -> float:
        """Last norm of the residual, relative to the load; NaN where nothing was iterated."""
        return self.residuals[-1] if self.residuals else float("nan")

    @property
    def iterations(self) -> int:
        """Number of Newton steps of the last attempt."""
        return max(len(self.residuals) - 1, 0)

    @property
    def orders(self) -> tuple[Fraction, ...]:
        """Orders of the speed that the motion has: those whose coefficients are not all zero."""
        amplitudes = self.harmonics.amplitudes(self.coefficients)
        return tuple(
            Fraction(multiple, self.harmonics.revolutions)
            for multiple, amplitude in zip(self.harmonics.multiples, amplitudes, strict=True)
            if amplitude.any()
        )

    @property
    def coefficients(self) -> Array:
        """Coefficients of all journals side by side [m], (rows, 2 dampers)."""
        return np.hstack([motion.coefficients for motion in self.journals.values()])

    @property
    def unknowns(self) -> Array:
        """What the equations solve for: the coefficients, flattened."""
        return self.coefficients.ravel()
