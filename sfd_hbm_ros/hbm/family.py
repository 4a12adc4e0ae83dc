"""Families of equations: harmonic balance as one parameter varies."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.newton import System
from sfd_hbm_ros.machine import Machine, get, override

Array = NDArray[np.float64]

_DIFFERENCE = 1e-4  # relative step at which equations are differenced by a general parameter,
_AGREEMENT = 1e-5  # unless both orders of differences disagree by more than this part:
_SMALLER = 0.1  # then a smaller one may be better, as next to a resonance of the shaft
_SMALLEST = 1e-9  # relative step, below which there is but rounding


class _Differences(NamedTuple):
    """Differences of fourth order, and of second order at the same nodes."""

    nodes: tuple[int, ...]
    weights: tuple[float, ...]
    fewer: tuple[float, ...]


_CENTRAL = _Differences((-2, -1, 1, 2), (1 / 12, -8 / 12, 8 / 12, -1 / 12), (0.0, -0.5, 0.5, 0.0))
_AHEAD = (-25 / 12, 4.0, -3.0, 4 / 3, -0.25), (-1.5, 2.0, -0.5, 0.0, 0.0)
_FORWARD = _Differences((0, 1, 2, 3, 4), *_AHEAD)
_BACKWARD = _Differences((0, -1, -2, -3, -4), *(tuple(-w for w in row) for row in _AHEAD))


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
    bounds : (2,) tuple of float, optional
        Least and greatest value that are asked for, such as those that the entry may have.
    """

    balance: HarmonicBalance
    speed: float
    path: str
    bounds: tuple[float, float] = (-math.inf, math.inf)
    _steps: list[float] = field(default_factory=list, repr=False, compare=False)

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
        return override(self.balance.machine, self.path, float(value))

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """See `Family`; by fourth-order differences of the residual, as any entry may vary.

        Next to a bound they are one-sided. Their step is so small that second-order ones agree
        with them: next to a resonance of the shaft the residual changes within a tiny distance.
        """
        low, high = self.bounds
        width = high - low
        size = max(abs(value), width if math.isfinite(width) else 0.0)
        size = size or float(abs(get(self.balance.machine, self.path))) or 1.0
        longest = min(_DIFFERENCE * size, width / 8.0)
        # what was good at the last place is about right at the next
        step = min(longest, self._steps[-1] / _SMALLER) if self._steps else longest
        best, least = None, math.inf
        while True:
            slope, error = self._difference(value, x, step)
            if best is None or error < least:
                best, least, self._steps[:] = slope, error, [step]
            if error <= _AGREEMENT or error > 2.0 * least or step * _SMALLER < _SMALLEST * size:
                return best
            step *= _SMALLER

    def _difference(self, value: float, x: Array, step: float) -> tuple[Array, float]:
        """Slope by differences, and by what part of it those of a lower order are off."""
        low, high = self.bounds
        nodes, weights, fewer = _CENTRAL
        if value - 2 * step < low:
            nodes, weights, fewer = _FORWARD
        elif value + 2 * step > high:
            nodes, weights, fewer = _BACKWARD
        residuals = np.array([self.at(value + m * step).residual(x) for m in nodes])
        slope: Array = np.array(weights) @ residuals / step
        off = np.linalg.norm(slope - np.array(fewer) @ residuals / step)
        norm = np.linalg.norm(slope)
        return slope, float(off / norm) if norm > 0.0 else 0.0


MachineFamily: TypeAlias = SpeedFamily | ParameterFamily
"""Families of which each member is a machine's own equations, and so known at any harmonics."""
