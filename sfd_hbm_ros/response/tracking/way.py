"""The way from one machine and speed to another, on which the machine changes in proportion."""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.family import FamilyMember
from sfd_hbm_ros.machine import Damper
from sfd_hbm_ros.rotor import RotorModel
from sfd_hbm_ros.rotor.model import Matrices

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Way:
    """The way from one machine and speed to another.

    On it the rotor's matrices, its forces, the dampers' numbers and the speed change in
    proportion. For loads and unbalance, for stiffness and mass, that is what the machine does.

    Attributes
    ----------
    start, end : HarmonicBalance
        The machines, with the same harmonics.
    start_speed, end_speed : float
        Rotor speeds [rad/s].
    """

    start: HarmonicBalance
    start_speed: float
    end: HarmonicBalance
    end_speed: float

    def at(self, part: float) -> Equations:
        """Equations at a part of the way, from 0 to 1.

        Raises
        ------
        ResonanceError
            If a harmonic meets an undamped resonance of the shaft there.
        """
        speed = self.start_speed + part * (self.end_speed - self.start_speed)
        return self._balance(part).at(self.end_speed if part == 1.0 else speed)

    def slope(self, equations: FamilyMember, value: float, x: Array) -> Array:
        """See `Family`; as if the residual changed in proportion with the machine.

        It does for forces, and nearly so for a film's viscosity. Points of a branch are solutions
        all the same, and its folds are where they are: there the Jacobian is singular.
        """
        slope = (self.end_speed - self.start_speed) * equations.slope_by_speed(x)
        if self._changes:
            before, after = (one.at(equations.speed) for one in (self.start, self.end))
            slope += after.residual(x) - before.residual(x)
        return slope

    @cached_property
    def _changes(self) -> bool:
        """Whether the machine changes; one that cannot be compared is the last all the way."""
        start, end = self.start, self.end
        sizes = [(one.model.size, one.clearances.size) for one in (start, end)]
        return start is not end and sizes[0] == sizes[1]

    def _balance(self, part: float) -> HarmonicBalance:
        """The machine at a part of the way."""
        start, end = self.start, self.end
        if part == 1.0 or not self._changes:
            return end
        if part == 0.0:
            return start
        dampers = tuple(
            _damper(*pair, part)
            for pair in zip(start.machine.dampers, end.machine.dampers, strict=True)
        )
        machine = replace(end.machine, dampers=dampers)
        return HarmonicBalance(machine, end.harmonics, _model(start.model, end.model, part))


def _damper(start: Damper, end: Damper, part: float) -> Damper:
    """A damper between two others."""
    changed: dict[str, Any] = {}
    for field in fields(end):
        before, after = getattr(start, field.name), getattr(end, field.name)
        if isinstance(before, float) and isinstance(after, float):
            changed[field.name] = before + part * (after - before)
    return replace(end, **changed)


def _model(start: RotorModel, end: RotorModel, part: float) -> RotorModel:
    """A rotor between two others."""
    pairs = zip(start.matrices, end.matrices, strict=True)
    forces = {
        name: getattr(start, name) + part * (getattr(end, name) - getattr(start, name))
        for name in ("unbalance", "static_force")
    }
    return replace(end, matrices=Matrices(*(a + part * (b - a) for a, b in pairs)), **forces)
