"""When the alarm of a jump is raised, how long it is held and how long it may be shelved."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated

from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import Rule, flag, number


class Level(IntEnum):
    """How bad something is; the numbers are those of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


def _margin(level: str, unit: str) -> Rule:
    return number(f"distance to the next jump below which to {level}, 0 for none", unit, least=0.0)


def _time(level: str) -> Rule:
    return number(f"time to the next jump below which to {level}, 0 for none", "s", least=0.0)


def _eccentricity(level: str) -> Rule:
    about = f"eccentricity, near the lock-up of the film, above which to {level}, 0 for none"
    return number(about, "of the clearance", least=0.0, below=1.0)


def _delay(about: str) -> Rule:
    return number(about, "s", least=0.0, below=3600.0)


@dataclass(frozen=True)
class AlarmSettings(Part):
    """Thresholds and times of the alarm.

    A level is entered where any of its thresholds is passed. It is left where each that was
    passed lies behind by the deadband.

    Raises
    ------
    MachineError
        If a value is not allowed, or an error would come before its warning.
    """

    margin_warn_rpm: Annotated[float, _margin("warn", "rpm")] = 60.0
    margin_error_rpm: Annotated[float, _margin("report an error", "rpm")] = 20.0
    margin_warn_percent: Annotated[float, _margin("warn", "% of the speed")] = 0.0
    margin_error_percent: Annotated[float, _margin("report an error", "% of the speed")] = 0.0
    time_warn: Annotated[float, _time("warn")] = 30.0
    time_error: Annotated[float, _time("report an error")] = 10.0
    eccentricity_warn: Annotated[float, _eccentricity("warn")] = 0.9
    eccentricity_error: Annotated[float, _eccentricity("report an error")] = 0.95
    deadband: Annotated[
        float,
        number("part of a threshold by which it must lie behind", "", least=0.0, below=1.0),
    ] = 0.1
    on_delay: Annotated[float, _delay("time for which a threshold must be passed")] = 0.1
    off_delay: Annotated[float, _delay("time for which all must lie behind")] = 2.0
    latch: Annotated[bool, flag("whether a level is held until it is reset")] = False
    shelf_time: Annotated[
        float, number("time after which shelving expires", "s", above=0.0, below=1e5)
    ] = 600.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for quantity, unit in (
            ("margin_{}_rpm", "rpm"),
            ("margin_{}_percent", "% of the speed"),
            ("time_{}", "s"),
        ):
            self._tighter(quantity, unit, -1.0)
        self._tighter("eccentricity_{}", "of the clearance", 1.0)

    def threshold(self, quantity: str, level: Level) -> float:
        """Return a level's threshold, such as that of ``margin_{}_rpm``; 0 for none."""
        return float(getattr(self, quantity.format(level.name.lower())))

    def _tighter(self, quantity: str, unit: str, sign: float) -> None:
        """Refuse an error's threshold that is passed no later than the warning's."""
        warn, error = (self.threshold(quantity, level) for level in (Level.WARN, Level.ERROR))
        if warn and error and not sign * error > sign * warn:
            side = "above" if sign > 0.0 else "below"
            key = quantity.format("warn")
            problem = f"must be {side} {key}, {warn:g} {unit}, or 0 for none, not {error:g}"
            raise self.error(quantity.format("error"), problem)
