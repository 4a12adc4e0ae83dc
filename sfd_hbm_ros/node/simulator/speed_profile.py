"""The speed of a machine that runs up, holds and coasts down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import integer, number
from sfd_hbm_ros.units import RPM

_STEPS = 6  # of Newton's method, which doubles the digits with each
_TOP_RPM = 1e6  # no rotor turns faster; the angle would lose its digits


@dataclass(frozen=True)
class SpeedProfile(Part):
    """Runs: run-up at a constant rate, a hold at the top and a coast-down at the same rate.

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
    runs: Annotated[int, integer("runs, one after the other", least=1)] = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.to_rpm < self.from_rpm:
            problem = f"must be at least from_rpm, {self.from_rpm:g} rpm, not {self.to_rpm:g}"
            raise self.error("to_rpm", problem)

    def __str__(self) -> str:
        up = f"run-up from {self.from_rpm:g} to {self.to_rpm:g} rpm in {self._leg:g} s"
        times = f", {self.runs} times" if self.runs > 1 else ""
        return f"{up}, {self.hold:g} s there, coast-down in {self._leg:g} s{times}"

    @property
    def duration(self) -> float:
        """Time from the start to the end [s]."""
        return self.runs * self._run

    def speed(self, time: float) -> float:
        """Return the speed [rad/s] at a time [s]."""
        _, within = self._divided(time)
        since_leg = min(within, self._run - within)
        return RPM * (self.from_rpm + self.rpm_per_second * self._within_leg(since_leg))

    def angle(self, time: float) -> float:
        """Return the angle [rad] turned since the start, the integral of the speed."""
        runs, within = self._divided(time)
        return runs * 2.0 * self._angle_up(0.5 * self._run) + self._angle_within(within)

    def time(self, angle: float, near: float) -> float:
        """Return the time [s] at which an angle [rad] has been turned, which is near another."""
        time = near
        for _ in range(_STEPS):
            time -= (self.angle(time) - angle) / self.speed(time)
        return time

    @property
    def _run(self) -> float:
        """Time of one run [s]."""
        return 2.0 * self._leg + self.hold

    def _divided(self, time: float) -> tuple[int, float]:
        """Return how many runs are over at a time, and the time within the next [s]."""
        if not 0.0 < self._run <= time:
            return 0, time
        runs = min(int(time / self._run), self.runs - 1)
        return runs, time - runs * self._run

    @property
    def _leg(self) -> float:
        """Time of the run-up, and of the coast-down [s]."""
        return (self.to_rpm - self.from_rpm) / self.rpm_per_second

    def _within_leg(self, time: float) -> float:
        """Return the nearest time that belongs to the run-up [s]."""
        return min(max(time, 0.0), self._leg)

    def _angle_within(self, time: float) -> float:
        """Return the angle [rad] turned since the start of a run."""
        if time <= 0.5 * self._run:
            return self._angle_up(time)
        return 2.0 * self._angle_up(0.5 * self._run) - self._angle_up(self._run - time)

    def _angle_up(self, time: float) -> float:
        """Return the angle [rad] as if the rotor stayed at the top after its run-up."""
        rising = self._within_leg(time)
        gain = self.rpm_per_second * rising * (time - 0.5 * rising)
        return RPM * (self.from_rpm * time + gain)
