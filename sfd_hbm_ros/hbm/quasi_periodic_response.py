"""A quasi-periodic response of an axisymmetric machine, and its stability."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.floquet import Stability, settled_stability
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.monodromy import monodromy, rates
from sfd_hbm_ros.hbm.solution import JournalMotion, Solution
from sfd_hbm_ros.hbm.turning_frame import absolute
from sfd_hbm_ros.rotor import reduce_model

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_REACH = 30.0  # multiple of the speed as `floquet.REACH`; these responses whirl faster than at it


@dataclass(frozen=True, eq=False)
class QuasiPeriodicResponse:
    """Response that is periodic in the frame that turns with the rotor.

    Attributes
    ----------
    speed : float
        Rotor speed W [rad/s].
    frequency : float
        Frequency w in the turning frame [rad/s]. In the fixed frame the response whirls at all
        W + k w.
    harmonics : Harmonics
        Multiples of w that were balanced.
    journals : mapping of str to JournalMotion
        Motion of each damper's journal in the turning frame, over the angle w t.
    """

    speed: float
    frequency: float
    harmonics: Harmonics
    journals: dict[str, JournalMotion]

    @property
    def frequency_ratio(self) -> float:
        """Frequency w of the speed W."""
        return self.frequency / self.speed

    @property
    def coefficients(self) -> Array:
        """Coefficients of all journals in the turning frame [m], (rows, 2 dampers)."""
        return np.hstack([motion.coefficients for motion in self.journals.values()])

    @property
    def unknowns(self) -> Array:
        """What the quasi-periodic equations solve for: coefficients and frequency."""
        return np.append(self.coefficients, self.frequency)

    @property
    def eccentricity_max(self) -> float:
        """Greatest eccentricity of any damper."""
        return max(motion.eccentricity_max for motion in self.journals.values())

    @property
    def amplitude(self) -> float:
        """Norm of the oscillation about the circle, of the clearance; it vanishes at the onset."""
        parts = [one.coefficients[1:] / one.clearance for one in self.journals.values()]
        return float(np.linalg.norm(parts))

    def whirl(self, damper: str) -> ComplexArray:
        """Amplitudes Z_k of x + i y = sum_k Z_k exp(i (W + k w) t) [m], k = -K ... K."""
        motion = self.journals[damper]
        x, y = motion.harmonics.amplitudes(motion.coefficients).T
        forward, backward = 0.5 * (x + 1j * y), 0.5 * (x - 1j * y).conj()
        return np.concatenate([backward[:0:-1], [x[0] + 1j * y[0]], forward[1:]])


def quasi_periodic_response(
    balance: HarmonicBalance, harmonics: Harmonics, speed: float, x: Array
) -> QuasiPeriodicResponse:
    """Response of unknowns (coefficients, w) that solve the quasi-periodic equations."""
    columns = np.hsplit(x[:-1].reshape(harmonics.rows, -1), len(balance.films))
    journals = {
        damper.name: JournalMotion(damper.name, damper.clearance, harmonics, q)
        for damper, q in zip(balance.machine.dampers, columns, strict=True)
    }
    return QuasiPeriodicResponse(speed, float(x[-1]), harmonics, journals)


def standing_response(
    circle: Solution, harmonics: Harmonics, frequency: float
) -> QuasiPeriodicResponse:
    """A circular orbit as the response whose oscillation at a frequency [rad/s] is nought."""
    journals = {}
    for name, motion in circle.journals.items():
        rows = np.zeros((harmonics.rows, 2))
        rows[0] = motion.at(np.zeros(1))[0]
        journals[name] = JournalMotion(name, motion.clearance, harmonics, rows)
    return QuasiPeriodicResponse(circle.speed, frequency, harmonics, journals)


def quasi_periodic_stability(
    balance: HarmonicBalance, response: QuasiPeriodicResponse
) -> Stability:
    """Floquet stability in the turning frame, over one period of the frequency w.

    A shift in time gives another response of the same kind: the multiplier 1 that belongs to it
    is left aside.
    """
    w, speed = response.frequency, response.speed
    rotor = reduce_model(balance.model, _REACH * speed)

    def monodromy_in(steps: int) -> Array:
        films = [
            film.linearise(*absolute(speed, journal.over(2 * steps, w)))
            for film, journal in zip(balance.films, response.journals.values(), strict=True)
        ]
        return monodromy(rates(rotor, films, speed, w, turning=speed), 2.0 * np.pi)

    return settled_stability(monodromy_in, phase_is_free=True)
