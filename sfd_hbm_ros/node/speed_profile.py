"""The speed of a machine that runs up, holds and coasts down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import number

RPM = 2.0 * math.pi / 60.0
"""One revolution per minute [rad/s]."""

_TOP_RPM = 1e6  # no rotor turns faster; the angle would lose its digits


@dataclass(frozen=True)
class SpeedProfile(Part):
    """Run-up at a constant rate, a hold at the top and a coast-down at the same rate.

    The start is at time 0; before it and after the end the rotor turns at `from_rpm`.

    Raises
    ------
    MachineError
        If a value is not allowed.
    """

    from_rpm: Annotated[
        float, number("speed at start and end", "rpm", above=0.0, below=_TOP_RPM)
    ] = 2000.0
    to_rpm: Annotated[float, number("speed at the top", "rpm", above=0.0, below=_TOP_RPM)] = 6000.0
    rpm_per_second: Annotated[
        float, number("change of the speed", "rpm/s", least=1e-3, below=_TOP_RPM)
    ] = 250.0
    hold: Annotated[float, number("time at the top", "s", least=0.0, below=1e6)] = 2.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.to_rpm < self.from_rpm:
            problem = f"must be at least from_rpm, {self.from_rpm:g} rpm, not {self.to_rpm:g}"
            raise self.error("to_rpm", problem)

    def __str__(self) -> str:
        up = f"run-up from {self.from_rpm:g} to {self.to_rpm:g} rpm in {self._leg:g} s"
        return f"{up}, {self.hold:g} s there, coast-down in {self._leg:g} s"

    @property
    def duration(self) -> float:
        """Time from the start to the end [s]."""
        return 2.0 * self._leg + self.hold

    def speed(self, time: float) -> float:
        """Return the speed [rad/s] at a time [s]."""
        since_leg = min(time, self.duration - time)
        return RPM * (self.from_rpm + self.rpm_per_second * self._within_leg(since_leg))

    def angle(self, time: float) -> float:
        """Return the angle [rad] turned since the start, the integral of the speed."""
        if time <= 0.5 * self.duration:
            return self._angle_up(time)
        return 2.0 * self._angle_up(0.5 * self.duration) - self._angle_up(self.duration - time)

    @property
    def _leg(self) -> float:
        """Time of the run-up, and of the coast-down [s]."""
        return (self.to_rpm - self.from_rpm) / self.rpm_per_second

    def _within_leg(self, time: float) -> float:
        """Return the nearest time that belongs to the run-up [s]."""
        return min(max(time, 0.0), self._leg)

    def _angle_up(self, time: float) -> float:
        """Return the angle [rad] as if the rotor stayed at the top after its run-up."""
        rising = self._within_leg(time)
        gain = self.rpm_per_second * rising * (time - 0.5 * rising)
        return RPM * (self.from_rpm * time + gain)
