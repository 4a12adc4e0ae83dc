"""Families of equations: harmonic balance as one parameter varies."""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.newton import System
from sfd_hbm_ros.machine import Machine, get, override

Array = NDArray[np.float64]

_DIFFERENCE = 1e-4  # relative step at which equations are differenced by a general parameter


class FamilyMember(System, Protocol):
    """Equations at one value of a parameter; unknown are n coefficients x."""

    @property
    def balance(self) -> HarmonicBalance:
        """The machine and the harmonics."""

    @property
    def speed(self) -> float:
        """Rotor speed [rad/s]."""

    @property
    def scale(self) -> Array:
        """What each unknown is compared to, (n,)."""

    def rotor_force(self, x: Array) -> Array:
        """Force that moves the rotor with the coefficients [N]."""

    def eccentricity(self, x: Array) -> float:
        """Greatest eccentricity of any journal."""

    def slope_by_speed(self, x: Array) -> Array:
        """Derivative of the residual by the speed [N s], (n,)."""


class Family(Protocol):
    """Equations that depend on one parameter."""

    def at(self, value: float) -> FamilyMember:
        """Equations at a value of the parameter."""

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """Derivative by the parameter of the residual of `equations`, those at `value`."""


@dataclass(frozen=True)
class SpeedFamily:
    """A machine as its speed [rad/s] varies."""

    balance: HarmonicBalance

    def at(self, value: float) -> Equations:
        """See `Family`."""
        return self.balance.at(value)

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """See `Family`; by the analytic derivatives of rotor and film."""
        return equations.slope_by_speed(x)


@dataclass(frozen=True)
class LoadFamily:
    """One speed as a part of the linear force is raised: force = base + value * part."""

    equations: Equations
    base: Array
    part: Array

    def at(self, value: float) -> Equations:
        """See `Family`."""
        return self.equations.with_force(self.base + value * self.part)

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """See `Family`."""
        return -self.part.ravel()


@dataclass(frozen=True)
class ParameterFamily:
    """One speed as an entry of the machine file varies.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    speed : float
        Rotor speed [rad/s].
    path : str
        Dotted path of the entry, a number.
    """

    balance: HarmonicBalance
    speed: float
    path: str

    def at(self, value: float) -> Equations:
        """See `Family`.

        Raises
        ------
        MachineError
            If the machine cannot be with that value.
        """
        return HarmonicBalance(self.machine(value), self.balance.harmonics).at(self.speed)

    def machine(self, value: float) -> Machine:
        """The machine at a value of the parameter."""
        return override(self.balance.machine, self.path, value)

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """See `Family`; by fourth-order differences of the residual, as any entry may vary."""
        step = _DIFFERENCE * (
            abs(value) or float(abs(get(self.balance.machine, self.path))) or 1.0
        )
        residual = [self.at(value + m * step).residual(x) for m in (-2, -1, 1, 2)]
        slope: Array = (residual[0] - 8 * residual[1] + 8 * residual[2] - residual[3]) / (
            12 * step
        )
        return slope


MachineFamily: TypeAlias = SpeedFamily | ParameterFamily
"""Families of which each member is a machine's own equations, and so known at any harmonics."""
