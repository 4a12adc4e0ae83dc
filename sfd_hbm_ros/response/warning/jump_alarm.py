"""The alarm of a machine that nears a jump or the lock-up of its film, in two levels."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any, NamedTuple

from sfd_hbm_ros.machine.errors import MachineError, show
from sfd_hbm_ros.machine.parts import Part, plain, read
from sfd_hbm_ros.machine.rules import number
from sfd_hbm_ros.response.warning.alarm import Alarm, AlarmMemory, AlarmState
from sfd_hbm_ros.response.warning.limits import FAR, LIMITS, Cause, Switches, readings
from sfd_hbm_ros.response.warning.outlook import Outlook
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

_NONE: Mapping[str, float] = MappingProxyType({})


class Answer(NamedTuple):
    """What became of a command, and why, in a sentence."""

    done: bool
    sentence: str


@dataclass(frozen=True)
class ShelfMemory(Part):
    """What of shelving outlives a restart."""

    remaining: Annotated[float, number("time until it expires", "s", least=0.0, below=1e5)]


class JumpAlarm:
    """Warns and reports an error as a jump or the lock-up of the film comes nearer.

    Times are seconds of a clock that never goes back.

    Parameters
    ----------
    settings : AlarmSettings
        Thresholds and times, which can be replaced at any time.

    Attributes
    ----------
    alarms : dict of Level to Alarm
        One alarm for each of the levels WARN and ERROR.
    """

    def __init__(self, settings: AlarmSettings) -> None:
        self.settings = settings
        self.alarms = {Level.WARN: Alarm(), Level.ERROR: Alarm()}
        self._switches = {level: Switches(level) for level in self.alarms}
        self._shelved_until = -math.inf

    def update(
        self,
        outlook: Outlook,
        eccentricity: float,
        now: float,
        others: Mapping[str, float] = _NONE,
        settings: AlarmSettings | None = None,
        doubtful: bool = False,
    ) -> None:
        """Take what is known of a machine now.

        What is not computable neither raises an alarm nor ends one.

        Parameters
        ----------
        outlook : Outlook
            What lies ahead.
        eccentricity : float
            Predicted, the greatest of any damper; NaN if unknown.
        now : float
            The time [s].
        others : mapping of str to float, optional
            Further readings, by the names of their `limits`; those left out are unknown.
        settings : AlarmSettings, optional
            Thresholds and times as they are for now; those of the alarm if left out.
        doubtful : bool, optional
            Whether model and machine differ. Then there is a warning whatever the model says, and
            no error that is the model's.
        """
        settings = settings or self.settings
        for level, alarm in self.alarms.items():
            given = {**readings(outlook, eccentricity, level), **others}
            believed = {**given, **FAR} if doubtful and level is Level.ERROR else given
            present = self._switches[level].update(believed, settings)
            present = present or (doubtful and level is Level.WARN)
            alarm.update(present, now, settings)

    def causes(self, now: float) -> list[Cause]:
        """The limits that hold the level which is shown; none where a delay or the latch does."""
        level = self.level(now)
        return self._switches[level].causes if level in self._switches else []

    def held_for(self, now: float) -> float:
        """Time for which the level shown is held yet by its off-delay [s]; 0 where it is not."""
        level = self.level(now)
        alarm = self.alarms.get(level)
        return alarm.ends_in(now, self.settings) if alarm else 0.0

    def level(self, now: float) -> Level:
        """The level to show: OK while shelved; where alarms latch, it is held until reset."""
        if self.shelved_for(now) > 0.0:
            return Level.OK
        held = self.settings.latch
        shown = [
            level for level, one in self.alarms.items() if one.active or (held and one.raised)
        ]
        return max(shown, default=Level.OK)

    def state(self, now: float) -> AlarmState:
        """Where the leading alarm stands."""
        return AlarmState.SHELVED if self.shelved_for(now) > 0.0 else self.leading.state

    @property
    def leading(self) -> Alarm:
        """The alarm to speak of: the worst active one, else the worst raised one, else WARN."""
        return max(
            self.alarms.items(),
            key=lambda item: (item[1].active, item[1].raised, item[0] * item[1].raised),
        )[1]

    def acknowledge(self) -> Answer:
        """Note that an operator has seen what is raised."""
        fresh = [one for one in self.alarms.values() if one.raised and not one.acknowledged]
        for alarm in fresh:
            alarm.acknowledge(self.settings.latch)
        return Answer(True, "acknowledged" if fresh else "there was nothing to acknowledge")

    def reset(self) -> Answer:
        """Return to normal, refused while anything is active or unacknowledged."""
        raised = [one for one in self.alarms.values() if one.raised]
        if any(one.active for one in raised):
            return Answer(False, "refused, since the alarm is still active")
        if not all(one.acknowledged for one in raised):
            return Answer(False, "refused, since the alarm must be acknowledged first")
        for alarm in raised:
            alarm.reset()
        return Answer(True, "reset" if raised else "there was nothing to reset")

    def shelve(self, now: float) -> Answer:
        """Hide the level for the shelf time from now on; behind it the alarm goes on."""
        self._shelved_until = now + self.settings.shelf_time
        return Answer(True, f"shelved for {self.settings.shelf_time:g} s")

    def unshelve(self) -> Answer:
        """Hide the level no longer."""
        self._shelved_until = -math.inf
        return Answer(True, "not shelved")

    def shelved_for(self, now: float) -> float:
        """Time until shelving expires [s]; 0 while not shelved."""
        return max(0.0, self._shelved_until - now)

    def to_dict(self, now: float) -> dict[str, Any]:
        """Plain data from which the alarm can be restored after a restart."""
        memories = {_key(level): plain(one.memory(now)) for level, one in self.alarms.items()}
        limits = {_key(level): switches.memory() for level, switches in self._switches.items()}
        shelf = plain(ShelfMemory(self.shelved_for(now)))
        return {**memories, "shelf": shelf, "limits": limits}

    @classmethod
    def from_dict(cls, settings: AlarmSettings, data: Mapping[str, Any], now: float) -> JumpAlarm:
        """The alarm as it was when the data were made; the time since does not count.

        Raises
        ------
        MachineError
            If the data are not those of an alarm.
        """
        alarm = cls(settings)
        for level in alarm.alarms:
            memory = read(AlarmMemory, data.get(_key(level)), _key(level))
            alarm.alarms[level] = Alarm.restored(memory, now)
            held = _limits_held(data.get("limits", {}), _key(level))
            alarm._switches[level].restore(held, settings)
        shelf = read(ShelfMemory, data.get("shelf"), "shelf")
        alarm._shelved_until = now + shelf.remaining
        return alarm


def _key(level: Level) -> str:
    return level.name.lower()


def _limits_held(data: object, level: str) -> Mapping[str, float]:
    """The last readings of the limits that held a level; older data have none.

    Raises
    ------
    MachineError
        If the data are no readings.
    """
    held = data.get(level, {}) if isinstance(data, Mapping) else data
    place = f"limits.{level}"
    if not isinstance(held, Mapping):
        raise MachineError(f"must be a mapping, not {show(held)}", place)
    for limit in LIMITS:
        reading = held.get(limit.name, 0.0)
        if not isinstance(reading, int | float) or not math.isfinite(reading):
            raise MachineError(f"must be a finite number, not {show(reading)}", limit.name, place)
    return held
