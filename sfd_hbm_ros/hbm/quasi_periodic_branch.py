"""The branch of quasi-periodic responses that leaves a circular orbit.

In the frame that turns with the rotor a circular orbit is an equilibrium and its Neimark-Sacker
bifurcation a Hopf bifurcation: a pair of exponents +-i w, whose eigenvector is the direction in
which the new motion of frequency w leaves (Kuznetsov 2004, Elements of Applied Bifurcation Theory,
sec. 3.4).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.family import FamilyMember
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.oscillation import oscillation
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.hbm.quasi_periodic import QuasiPeriodicEquations
from sfd_hbm_ros.hbm.quasi_periodic_response import (
    QuasiPeriodicResponse,
    quasi_periodic_response,
    standing_response,
)
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.hbm.switching import SwitchedBranch, point_beside
from sfd_hbm_ros.rotor import is_axisymmetric

Array = NDArray[np.float64]

_MULTIPLES = Harmonics(15)  # of the new frequency; the film is stiff where a circle is unstable
_RESOLVED = 0.995  # eccentricity up to which so many multiples tell where the journal is


@dataclass(frozen=True, eq=False)
class QuasiPeriodicFamily:
    """Quasi-periodic responses of a machine as its speed varies: a `Family`.

    Attributes are those of `QuasiPeriodicEquations`, but for the speed.
    """

    balance: HarmonicBalance
    harmonics: Harmonics
    phase: Array
    frequency_scale: float

    def at(self, value: float) -> QuasiPeriodicEquations:
        """Equations at a speed [rad/s]."""
        return QuasiPeriodicEquations(
            self.balance, self.harmonics, value, self.phase, self.frequency_scale
        )

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """Derivative by the speed of the residual of `equations`, those at `value`."""
        return equations.slope_by_speed(x)


class QuasiPeriodicBranch(SwitchedBranch):
    """A branch of quasi-periodic responses, followed until it joins circular orbits again."""

    family: QuasiPeriodicFamily

    def response(self, point: Point) -> QuasiPeriodicResponse:
        """The response at one of its points."""
        family = self.family
        return quasi_periodic_response(family.balance, family.harmonics, point.value, point.x)


def has_circular_orbits(balance: HarmonicBalance) -> bool:
    """Whether a machine is axisymmetric and without gravity and other static loads."""
    return is_axisymmetric(balance.model) and not balance.model.static_force.any()


def quasi_periodic_branch(
    balance: HarmonicBalance,
    circle: Solution,
    bounds: tuple[float, float],
    harmonics: Harmonics = _MULTIPLES,
    options: ContinuationOptions | None = None,
) -> QuasiPeriodicBranch | None:
    """The quasi-periodic responses that leave a circular orbit at a Neimark-Sacker bifurcation.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine, axisymmetric and without gravity and other static loads.
    circle : Solution
        Its circular orbit at the bifurcation.
    bounds : (2,) tuple of float
        Range of the speed [rad/s] in which the branch is followed.
    harmonics : Harmonics
        Multiples of the new frequency to balance, all up to the highest.
    options : ContinuationOptions, optional
        Settings of the continuation. The branch ends at an eccentricity of 0.995 at most, up to
        which the multiples resolve it.

    Returns
    -------
    QuasiPeriodicBranch
        An iterator of points, from the circle on. None where no response beside it was found.

    Raises
    ------
    ValueError
        If the machine's orbits are not circles.
    """
    if not has_circular_orbits(balance):
        raise ValueError(
            "quasi-periodic branch: the machine must be axisymmetric, without gravity and static "
            "loads, so that its orbits are circles"
        )
    family, root = _departure(balance, circle, harmonics)
    absent = np.ones(root.x.size, dtype=bool)
    absent[: balance.clearances.size] = absent[-1] = False
    options = options or ContinuationOptions()
    options = replace(options, eccentricity=min(options.eccentricity, _RESOLVED))
    first = point_beside(family, root, bounds, options)
    return QuasiPeriodicBranch(family, first, absent, bounds, options) if first else None


def _departure(
    balance: HarmonicBalance, circle: Solution, harmonics: Harmonics
) -> tuple[QuasiPeriodicFamily, Point]:
    """The equations, and the circle as a point whose tangent is the oscillation that sets in."""
    clearances = balance.clearances
    exponent, journals = oscillation(balance, circle)
    amplitudes = np.zeros((len(harmonics.orders), clearances.size), dtype=complex)
    amplitudes[1] = journals / np.linalg.norm(journals / clearances)
    leaving = harmonics.coefficients(amplitudes) / clearances
    ahead = harmonics.coefficients(1j * amplitudes)  # the same motion a quarter period later
    phase = (ahead / clearances**2).ravel()
    family = QuasiPeriodicFamily(balance, harmonics, phase, exponent.imag)
    x = standing_response(circle, harmonics, exponent.imag).unknowns
    tangent = np.append(leaving, [0.0, 0.0])
    return family, Point(circle.speed, x, tangent, circle.eccentricity_max, 0)
