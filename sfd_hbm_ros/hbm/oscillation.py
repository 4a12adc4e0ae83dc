"""Small oscillations about a circular orbit, which stands still in the turning frame."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.floquet import REACH
from sfd_hbm_ros.hbm.monodromy import rates
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.hbm.turning_frame import absolute
from sfd_hbm_ros.rotor import reduce_model

ComplexArray = NDArray[np.complex128]


class Oscillation(NamedTuple):
    """The disturbance of a circular orbit that decays least, as the turning frame sees it.

    Attributes
    ----------
    exponent : complex
        Its growth and frequency in exp(exponent t) [1/s].
    journals : (n,) complex array
        Its shape at the journals.
    """

    exponent: complex
    journals: ComplexArray


def oscillation(balance: HarmonicBalance, circle: Solution) -> Oscillation:
    """Least damped oscillation about a circular orbit, by the eigenvalues in the turning frame.

    Unlike a multiplier over a revolution they tell a frequency from its sums with the speed.
    """
    speed = circle.speed
    rotor = reduce_model(balance.model, REACH * speed)
    films = []
    for film, journal in zip(balance.films, circle.journals.values(), strict=True):
        p = journal.at(np.zeros(1))
        films.append(film.linearise(*absolute(speed, (p, 0.0 * p, 0.0 * p))))
    exponents, vectors = np.linalg.eig(rates(rotor, films, speed, speed, turning=speed)[0])
    least = int(np.argmax(np.where(exponents.imag > 0.0, exponents.real, -np.inf)))
    return Oscillation(complex(exponents[least]) * speed, vectors[rotor.journals.ravel(), least])
