"""Quasi-periodic response of an axisymmetric machine: harmonic balance in the turning frame.

In the frame that turns with the rotor a circular orbit stands still. The response that leaves it
at a Neimark-Sacker bifurcation has a second frequency w and is periodic in that frame:

    x + i y = exp(i W t) sum_k Z_k exp(i k w t),    k = -K ... K.

The rotor whirls at the frequencies W + k w and has a condensed stiffness at each. Unknown are the
coefficients of the motion in the turning frame and w itself; where in its period the motion begins
is of no account, and one more equation fixes it (Seydel 2010, Practical Bifurcation and Stability
Analysis, sec. 7.1).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.clearance import greatest_eccentricity, largest_step
from sfd_hbm_ros.hbm.film_terms import FilmTerms, LatestTerms
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.turning_frame import TurningFilm, slopes_by_turning
from sfd_hbm_ros.hbm.turning_rotor import TurningRotor

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class QuasiPeriodicEquations:
    """Harmonic balance in the turning frame at one speed, of unknowns x = (coefficients, w).

    Attributes
    ----------
    balance : HarmonicBalance
        The machine, axisymmetric and without static loads.
    harmonics : Harmonics
        Multiples of w, all up to the highest. The coefficients are (rows, n), flattened.
    speed : float
        Rotor speed W [rad/s].
    phase : (rows n,) array
        Row of the linear condition on the coefficients that fixes the phase [1/m].
    frequency_scale : float
        What w is compared to [rad/s].
    """

    balance: HarmonicBalance
    harmonics: Harmonics
    speed: float
    phase: Array
    frequency_scale: float

    @cached_property
    def load(self) -> float:
        """Norm of all linear forces on the rotor [N], to which residuals are compared."""
        return float(np.linalg.norm(self.balance.model.linear_force(self.speed, [1])))

    @property
    def scale(self) -> Array:
        """What each unknown is compared to: the clearance [m], w's scale [rad/s]."""
        clearances = np.tile(self.balance.clearances, self.harmonics.rows)
        return np.append(clearances, self.frequency_scale)

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Imbalance of the forces and of the phase [N], and its derivative by the unknowns."""
        q, w = x[:-1], float(x[-1])
        linear, force = self._rotor.at(w)
        films = self._films(x)
        residual = linear @ q - force - films.force().ravel()
        by_frequency = self._rotor.slope_by_frequency(w) @ q - films.slope_by_frequency().ravel()
        films.subtract_derivative(linear)
        phase = self.load * self.phase
        jacobian = np.block([[linear, by_frequency[:, np.newaxis]], [phase, 0.0]])
        return np.append(residual, phase @ q), jacobian

    def slope_by_speed(self, x: Array) -> Array:
        """Derivative of the residual by the speed [N s] at the same w, (rows n + 1,)."""
        linear, force = self._rotor.slope_by_speed(float(x[-1]))
        by_turning = self._films(x).slope_by_rates(slopes_by_turning)
        return np.append(linear @ x[:-1] - force - by_turning.ravel(), 0.0)

    def rotor_force(self, x: Array) -> Array:
        """Force that moves the rotor with the coefficients [N], (rows n,)."""
        linear, _ = self._rotor.at(float(x[-1]))
        force: Array = linear @ x[:-1]
        return force

    def eccentricity(self, x: Array) -> float:
        """Greatest eccentricity of any journal at the time samples."""
        return greatest_eccentricity(self._positions(x), self.balance.clearances)

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a step, at most 1, that keeps every time sample off the clearance."""
        return largest_step(self._positions(x), self._positions(step), self.balance.clearances)

    def _positions(self, x: Array) -> Array:
        positions: Array = self.harmonics.bases[0] @ x[:-1].reshape(self.harmonics.rows, -1)
        return positions

    @cached_property
    def _rotor(self) -> TurningRotor:
        return TurningRotor(self.balance.condensation, self.harmonics, self.speed)

    @cached_property
    def _films(self) -> LatestTerms:
        films = [TurningFilm(film, self.speed) for film in self.balance.films]
        return LatestTerms(
            lambda x: FilmTerms(
                self.harmonics, films, float(x[-1]), x[:-1].reshape(self.harmonics.rows, -1)
            )
        )
