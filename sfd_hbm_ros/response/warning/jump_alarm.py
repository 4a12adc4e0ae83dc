"""The alarm of a machine that nears a jump or the lock-up of its film, in two levels."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

from sfd_hbm_ros.machine.parts import Part, plain, read
from sfd_hbm_ros.machine.rules import number
from sfd_hbm_ros.response.warning.alarm import Alarm, AlarmMemory, AlarmState
from sfd_hbm_ros.response.warning.outlook import Outlook
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level
from sfd_hbm_ros.units import RPM


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
        self._shelved_until = -math.inf

    def update(self, outlook: Outlook, eccentricity: float, now: float) -> None:
        """Take what lies ahead and the greatest eccentricity of any damper, NaN if unknown.

        What is not computable neither raises an alarm nor ends one.
        """
        for level, alarm in self.alarms.items():
            present = _present(alarm.present, level, outlook, eccentricity, self.settings)
            alarm.update(present, now, self.settings)

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
        return {**memories, "shelf": plain(ShelfMemory(self.shelved_for(now)))}

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
        shelf = read(ShelfMemory, data.get("shelf"), "shelf")
        alarm._shelved_until = now + shelf.remaining
        return alarm


def _key(level: Level) -> str:
    return level.name.lower()


def _present(
    before: bool, level: Level, outlook: Outlook, eccentricity: float, settings: AlarmSettings
) -> bool:
    """Whether a threshold of a level is passed, or was and not all lie behind by the deadband.

    Every comparison with NaN is false, so that what is unknown leaves things as they were.
    """
    small = {
        "margin_{}_rpm": outlook.margin / RPM,
        "margin_{}_percent": 100.0 * outlook.relative_margin,
        "time_{}": outlook.time_to_jump,
    }
    band = settings.deadband
    for quantity, value in small.items():
        limit = settings.threshold(quantity, level)
        if limit and (not value > (1.0 + band) * limit if before else value < limit):
            return True
    limit = settings.threshold("eccentricity_{}", level)
    holds = not eccentricity < (1.0 - band) * limit if before else eccentricity > limit
    return bool(limit) and holds
