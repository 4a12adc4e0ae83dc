"""The limits that hold the alarm of a machine: a row for each quantity, a switch at each level.

Whoever has another cause of an alarm adds a row to `LIMITS` and gives its reading to
`JumpAlarm.update`. Every switch has its own state and deadband, so that what one quantity has
raised is never held by another.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

from sfd_hbm_ros.response.warning.outlook import Outlook
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level
from sfd_hbm_ros.units import RPM


@dataclass(frozen=True)
class Limit:
    """A quantity that an alarm looks at.

    Attributes
    ----------
    name : str
        Its name among the readings and in the state file.
    threshold : str
        Its thresholds among the settings, such as ``time_{}``; several quantities may share them.
    about : str
        What it is, in words.
    unit : str
        Its unit as it is written after a number, with a space before it.
    above : bool
        Whether it is bad above its threshold, or else below.
    digits : int
        Decimal places for people.
    """

    name: str
    threshold: str
    about: str
    unit: str = ""
    above: bool = False
    digits: int = 0

    def passed(self, reading: float, limit: float) -> bool:
        """Whether a reading lies on the bad side of a limit."""
        return reading > limit if self.above else reading < limit

    def shown(self, value: float) -> str:
        """Return a value with its unit, without zeros that say nothing."""
        return f"{round(value, self.digits):g}{self.unit}"


MARGIN = Limit("margin_rpm", "margin_{}_rpm", "margin to the jump", " rpm")
MARGIN_PERCENT = Limit(
    "margin_percent", "margin_{}_percent", "margin to the jump", " % of the speed", digits=1
)
TIME = Limit("time", "time_{}", "time to the jump", " s", digits=1)
ECCENTRICITY = Limit("eccentricity", "eccentricity_{}", "eccentricity", above=True, digits=2)

MEASURED = Limit(
    "measured_eccentricity",
    "eccentricity_{}",
    "measured eccentricity",
    above=True,
    digits=2,
)

LIMITS = (MARGIN, MARGIN_PERCENT, TIME, ECCENTRICITY, MEASURED)
"""All that raises the alarm."""

FAR = {
    limit.name: -math.inf if limit.above else math.inf for limit in LIMITS if limit is not MEASURED
}
"""Readings of what a model tells that hold no alarm."""


def readings(outlook: Outlook, eccentricity: float, level: Level) -> dict[str, float]:
    """Return what the outlook and the greatest eccentricity say about a level's limits, by name.

    A warning does not wait until the acceleration has settled, as an error does: while another
    one is taken over, the time seems longer than it is.
    NaN stands for what is not known (REP 117).
    """
    return {
        MARGIN.name: outlook.margin / RPM,
        MARGIN_PERCENT.name: 100.0 * outlook.relative_margin,
        TIME.name: outlook.time_to_jump if level is Level.ERROR else outlook.rough_time_to_jump,
        ECCENTRICITY.name: eccentricity,
    }


class Side(StrEnum):
    """Where a reading that holds an alarm lies."""

    BEYOND = "beyond the limit"
    DEADBAND = "within the deadband"
    UNKNOWN = "not known now, last beyond"


@dataclass(frozen=True)
class Cause:
    """A limit that holds a level.

    Attributes
    ----------
    limit : Limit
        The limit.
    threshold : float
        Its value at this level.
    release : float
        What the reading must pass, so that it holds the level no longer.
    reading : float
        What it read when last known.
    side : Side
        Where that lies.
    """

    limit: Limit
    threshold: float
    release: float
    reading: float
    side: Side

    def __str__(self) -> str:
        reading, threshold = (
            f"{value:.6g}{self.limit.unit}" for value in (self.reading, self.threshold)
        )
        return f"{self.limit.about} {reading}, limit {threshold}, {self.side}"


class Switch:
    """Whether one limit holds one level.

    It is on from a reading beyond the threshold until one that lies behind it by the deadband. A
    reading that is not known leaves it as it is.

    Parameters
    ----------
    limit : Limit
        The limit.
    level : Level
        The level.
    """

    def __init__(self, limit: Limit, level: Level) -> None:
        self._limit = limit
        self._level = level
        self._threshold = math.nan
        self._release = math.nan
        self._reading = math.nan  # the last that was known
        self._known = False  # whether there is one now
        self._on = False

    def update(self, reading: float, settings: AlarmSettings) -> None:
        """Take a reading; NaN if it is not known."""
        threshold = settings.threshold(self._limit.threshold, self._level)
        band = settings.deadband if self._limit.above else -settings.deadband
        self._threshold, self._release = threshold, (1.0 - band) * threshold
        self._known = not math.isnan(reading)
        if self._known:
            self._reading = reading
            # The release itself has not passed: where the deadband is 0, both are one.
            held = self._limit.passed(reading, self._release) or reading == self._release
            self._on = self._limit.passed(reading, threshold) or (self._on and held)
        self._on = self._on and threshold > 0.0

    @property
    def cause(self) -> Cause | None:
        """The cause that it is; None while it is off."""
        if not self._on:
            return None
        beyond = self._limit.passed(self._reading, self._threshold)
        side = Side.BEYOND if beyond else Side.DEADBAND
        return Cause(
            self._limit,
            self._threshold,
            self._release,
            self._reading,
            side if self._known else Side.UNKNOWN,
        )

    def restore(self, reading: float, settings: AlarmSettings) -> None:
        """Be on as before a restart, when there was this reading."""
        self._on = True
        self.update(reading, settings)
        self._known = False


class Switches:
    """The switches of one level.

    Parameters
    ----------
    level : Level
        The level.
    """

    def __init__(self, level: Level) -> None:
        self._switches = {limit.name: Switch(limit, level) for limit in LIMITS}

    def update(self, given: Mapping[str, float], settings: AlarmSettings) -> bool:
        """Take the readings that there are, by the limits' names; return whether any is on."""
        for name, switch in self._switches.items():
            switch.update(given.get(name, math.nan), settings)
        return bool(self.causes)

    @property
    def causes(self) -> list[Cause]:
        """What holds the level."""
        found = (switch.cause for switch in self._switches.values())
        return [cause for cause in found if cause is not None]

    def memory(self) -> dict[str, float]:
        """What outlives a restart: the last readings of those that are on."""
        return {cause.limit.name: cause.reading for cause in self.causes}

    def restore(self, memory: Mapping[str, float], settings: AlarmSettings) -> None:
        """Be as before a restart; names that are not known are left out."""
        for name, reading in memory.items():
            if name in self._switches:
                self._switches[name].restore(reading, settings)


class Approach:
    """Limits of the time to a jump that leave room between a warning and its error.

    A fast ramp may bring a jump from nowhere to within the limits of both levels at once, as soon
    as its acceleration is known. The time that there is then is divided as the limits divide
    theirs: where a warning comes 6 s before the jump in place of 30 s, its error comes 2 s before
    it in place of 10 s.
    """

    def __init__(self) -> None:
        self._lead = math.inf  # time to the jump when it came within the warning's limit [s]
        self._near = False

    def fitted(self, settings: AlarmSettings, time: float, reported: bool) -> AlarmSettings:
        """Return the settings with the limits that the present ramp leaves room for.

        Parameters
        ----------
        settings : AlarmSettings
            The settings as given.
        time : float
            Time to the jump [s]; NaN while unknown, which leaves things as they were.
        reported : bool
            Whether an error is reported already.
        """
        if not settings.time_warn:
            return settings
        if time > (1.0 + settings.deadband) * settings.time_warn:
            self._near = False
        elif time < settings.time_warn and not self._near:
            self._near, self._lead = True, math.inf if reported else time
        if not self._near or self._lead >= settings.time_warn:
            return settings
        part = self._lead / settings.time_warn
        return replace(settings, time_error=part * settings.time_error)
