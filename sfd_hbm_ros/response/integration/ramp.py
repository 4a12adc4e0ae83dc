"""The rotor's speed during a run-up or a coast-down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.options import OptionError
from sfd_hbm_ros.response.curves.jumps import Direction

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_REVOLUTION = 2.0 * np.pi  # [rad]
_ROUNDING = 1e-6  # by which a whole number of revolutions may be missed


class Stages(NamedTuple):
    """A time step of a run, and s stages in it.

    Attributes
    ----------
    length : float
        Length of the step [s].
    speed : (s,) array
        Rotor speed [rad/s].
    turning : (s,) complex array
        Factor by which the unbalance's amplitude gives its force [rad2/s2], the mass being off
        the axis of a rotor that turns by the angle: Re(U turning), turning = (W^2 - i dW/dt)
        exp(i angle).
    """

    length: float
    speed: Array
    turning: ComplexArray


@dataclass(frozen=True)
class Ramp:
    """Speed that changes at a constant rate over a number of whole revolutions.

    Parameters
    ----------
    start : float
        Speed at the start [rad/s], positive.
    acceleration : float
        Angular acceleration [rad/s2], negative for a coast-down, zero for a constant speed.
    revolutions : int
        Number of revolutions, at least 1.

    Raises
    ------
    OptionError
        If a number is out of its range, or the rotor would stop on the way.
    """

    start: float
    acceleration: float
    revolutions: int

    def __post_init__(self) -> None:
        _positive("start", self.start, "rad/s")
        if self.revolutions < 1:
            raise OptionError(
                f"revolutions: {self.revolutions} is not allowed, it must be at least 1"
            )
        if not self.start**2 + 2.0 * self.acceleration * _REVOLUTION * self.revolutions > 0.0:
            raise OptionError(
                f"acceleration: {self.acceleration} rad/s2 is not allowed, the rotor must not "
                f"stop within {self.revolutions} revolutions from {self.start} rad/s"
            )

    @classmethod
    def between(cls, start: float, end: float, rate: float) -> Ramp:
        """Run from one speed to another [rad/s], up or down, at a positive rate [rad/s2].

        It ends with the last whole revolution before the end speed.

        Raises
        ------
        OptionError
            If a number is not positive and finite, or the run is shorter than a revolution.
        """
        _positive("start", start, "rad/s")
        _positive("end", end, "rad/s")
        _positive("rate", rate, "rad/s2")
        acceleration = rate if end > start else -rate
        angle = (end**2 - start**2) / (2.0 * acceleration)
        revolutions = int(angle / _REVOLUTION + _ROUNDING)
        if revolutions < 1:
            raise OptionError(
                f"rate: {rate:g} rad/s2 leads from {start:g} to {end:g} rad/s in less than a "
                "revolution"
            )
        return cls(start, acceleration, revolutions)

    @property
    def direction(self) -> Direction | None:
        """Whether the speed rises or falls; None for a constant speed."""
        if self.acceleration == 0.0:
            return None
        return Direction.RUN_UP if self.acceleration > 0.0 else Direction.COAST_DOWN

    def speed(self, revolutions: Array) -> Array:
        """Speed [rad/s] after numbers of revolutions."""
        speed: Array = np.sqrt(self.start**2 + 2.0 * self.acceleration * _REVOLUTION * revolutions)
        return speed

    def time(self, revolutions: Array) -> Array:
        """Time [s] that numbers of revolutions take."""
        time: Array = 2.0 * _REVOLUTION * revolutions / (self.start + self.speed(revolutions))
        return time

    def stages(self, start: float, width: float, nodes: Array) -> Stages:
        """A step over a part of the run, with stages at nodes of it.

        Parameters
        ----------
        start, width : float
            Where the part begins, and how much it holds [revolutions].
        nodes : (s,) array
            Times of the stages, from 0 to 1.
        """
        begin, end = self.speed(np.array([start, start + width]))
        length = float(2.0 * _REVOLUTION * width / (begin + end))
        time = length * nodes
        speed = begin + self.acceleration * time
        angle = _REVOLUTION * (start % 1.0) + 0.5 * (begin + speed) * time
        turning = (speed**2 - 1j * self.acceleration) * np.exp(1j * angle)
        return Stages(length, speed, turning)


def _positive(name: str, value: float, unit: str) -> None:
    if not (np.isfinite(value) and value > 0.0):
        raise OptionError(f"{name}: {value} {unit} is not allowed, it must be positive and finite")
