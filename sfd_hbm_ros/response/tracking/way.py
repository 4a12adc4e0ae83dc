"""The way from one machine and speed to another, on which the machine changes in proportion."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.family import FamilyMember
from sfd_hbm_ros.machine import Damper
from sfd_hbm_ros.rotor import RotorModel

Array = NDArray[np.float64]

_STEP = 1e-4  # part of the way over which equations are differenced


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
        """See `Family`; where the machine changes, by differences of the residual."""
        if self.start is self.end:
            return (self.end_speed - self.start_speed) * equations.slope_by_speed(x)
        after, before = (self.at(value + step).residual(x) for step in (_STEP, -_STEP))
        slope: Array = (after - before) / (2.0 * _STEP)
        return slope

    def _balance(self, part: float) -> HarmonicBalance:
        """The machine at a part of the way; the last one where the two cannot be compared."""
        start, end = self.start, self.end
        comparable = (start.model.size, start.clearances.size) == (
            end.model.size,
            end.clearances.size,
        )
        if part == 1.0 or start is end or not comparable:
            return end
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
    names = ("M", "C", "G", "K", "unbalance", "static_force")
    pairs = {name: (getattr(start, name), getattr(end, name)) for name in names}
    return replace(end, **{name: a + part * (b - a) for name, (a, b) in pairs.items()})
