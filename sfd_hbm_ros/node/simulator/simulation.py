"""What the simulator is told to play: a run of a machine, and how it is measured. Without ROS."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import override_all, read_machine
from sfd_hbm_ros.machine.rules import choice, integer, number, title
from sfd_hbm_ros.node.simulator.disturbance import DisturbanceSettings
from sfd_hbm_ros.node.simulator.integrated_machine import IntegratedMachine
from sfd_hbm_ros.node.simulator.played_machine import BareSpeed, PlayedMachine, TrackedMachine
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.judged import Progress
from sfd_hbm_ros.units import RPM

_MOST_HARMONICS = 31
_BESIDE = 0.02  # part of itself by which the curve's range goes beyond that of the speed
_SOURCES: dict[str, Callable[[ResponseCurve, SpeedProfile], PlayedMachine]] = {
    "branch": TrackedMachine,
    "integration": IntegratedMachine,
}


@dataclass(frozen=True)
class Settings(SpeedProfile, DisturbanceSettings):
    """The simulator's parameters, beside the values of its machine.

    Raises
    ------
    MachineError
        If a value is not allowed.
    """

    rate: Annotated[float, number("speeds a second", "Hz", least=0.1, below=1e4)] = 50.0
    subscribers: Annotated[int, integer("subscribers to wait for", least=0)] = 1
    machine_file: Annotated[
        str, title("path of the file of the machine that is measured, empty for none", default="")
    ] = ""
    source: Annotated[
        str, choice("where the measured orbits come from: a stable branch, or time", _SOURCES)
    ] = "branch"
    orbit_rate: Annotated[
        float, number("measured orbits a second, at most one a speed", "Hz", least=0.1, below=1e4)
    ] = 10.0
    harmonics: Annotated[int, integer("highest harmonic of the orbits", least=1)] = 7

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.harmonics > _MOST_HARMONICS:
            problem = f"must be at most {_MOST_HARMONICS}, not {self.harmonics}"
            raise self.error("harmonics", problem)


def play(settings: Settings, values: Mapping[str, object], progress: Progress) -> PlayedMachine:
    """Return the machine to play, with the response curve that guides it.

    Parameters
    ----------
    settings : Settings
        What to play.
    values : mapping
        Values of the machine that take precedence over its file's.
    progress : callable
        Called with the speed [rad/s] of every new point of the curve.

    Raises
    ------
    MachineError
        If the machine file or a value is not allowed.
    NoSolutionError
        If the machine has no solution at an end of the run's range.
    """
    if not settings.machine_file:
        return BareSpeed()
    machine = override_all(read_machine(settings.machine_file), values)
    balance = HarmonicBalance(machine, Harmonics(settings.harmonics))
    lowest = (1.0 - _BESIDE) * settings.from_rpm * RPM
    highest = (1.0 + _BESIDE) * settings.to_rpm * RPM
    curve = response_curve(balance, lowest, highest, progress=progress)
    return _SOURCES[settings.source](curve, settings)
