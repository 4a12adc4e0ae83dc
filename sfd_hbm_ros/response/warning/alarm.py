"""One alarm, in the states of ISA-18.2 and IEC 62682.

    normal  --active-->  unacknowledged  --acknowledge-->  acknowledged
                               |                                |
                        returns to normal                returns to normal
                               v                                v
                           returned  ----acknowledge---->    latched  --reset-->  normal

Where alarms do not latch, they pass through latched to normal by themselves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import flag, integer, number
from sfd_hbm_ros.response.warning.settings import AlarmSettings


class AlarmState(StrEnum):
    """Where an alarm stands with its operator."""

    NORMAL = "normal"
    UNACKNOWLEDGED = "active, unacknowledged"
    ACKNOWLEDGED = "active, acknowledged"
    RETURNED = "returned to normal, unacknowledged"
    LATCHED = "returned to normal, acknowledged, not reset"
    SHELVED = "shelved"


@dataclass(frozen=True)
class AlarmMemory(Part):
    """What of an alarm outlives a restart.

    Raises
    ------
    MachineError
        If a value is not allowed.
    """

    present: Annotated[bool, flag("whether the condition held when last looked at")]
    active: Annotated[bool, flag("whether it held for its delay")]
    raised: Annotated[bool, flag("whether the alarm is in another state than normal")]
    acknowledged: Annotated[bool, flag("whether it was acknowledged since it was raised")]
    occurrences: Annotated[int, integer("how often it was raised", least=0)]
    age: Annotated[float, number("time since it was raised", "s", least=0.0)]


class Alarm:
    """One alarm.

    Times are seconds of a clock that never goes back. Delays are counted from the call of
    `update` that first saw a change, and have passed at the first call after their end.

    Attributes
    ----------
    present : bool
        Whether the condition holds.
    active : bool
        Whether it does after the delays.
    raised : bool
        Whether the alarm is in another state than normal.
    acknowledged : bool
        Whether it was acknowledged since it was raised.
    occurrences : int
        How often it was raised.
    since : float
        When it was last raised [s]; NaN if it never was.
    """

    def __init__(self) -> None:
        self.present = False
        self.active = False
        self.raised = False
        self.acknowledged = False
        self.occurrences = 0
        self.since = math.nan
        self._changed = -math.inf

    @property
    def state(self) -> AlarmState:
        """Where the alarm stands."""
        if not self.raised:
            return AlarmState.NORMAL
        if self.active:
            return AlarmState.ACKNOWLEDGED if self.acknowledged else AlarmState.UNACKNOWLEDGED
        return AlarmState.LATCHED if self.acknowledged else AlarmState.RETURNED

    def update(self, present: bool, now: float, settings: AlarmSettings) -> None:
        """Take whether the condition holds now [s]."""
        if present != self.present:
            self.present, self._changed = present, now
        delay = settings.on_delay if present else settings.off_delay
        if present != self.active and now - self._changed >= delay:
            self.active = present
            if present:
                self._raise(now)
        self._settle(settings.latch)

    def ends_in(self, now: float, settings: AlarmSettings) -> float:
        """Time until it is active no longer, as its condition holds no longer [s]; else 0."""
        if self.present or not self.active:
            return 0.0
        return max(0.0, self._changed + settings.off_delay - now)

    def acknowledge(self, latch: bool) -> None:
        """Note that an operator has seen the alarm."""
        self.acknowledged = self.raised
        self._settle(latch)

    def reset(self) -> None:
        """Return to normal, which must not be asked of an active or unacknowledged alarm."""
        assert self.state in (AlarmState.NORMAL, AlarmState.LATCHED)
        self.raised = self.acknowledged = False

    def memory(self, now: float) -> AlarmMemory:
        """What is to outlive a restart."""
        age = now - self.since if self.occurrences else 0.0
        state = self.present, self.active, self.raised, self.acknowledged
        return AlarmMemory(*state, self.occurrences, age)

    @classmethod
    def restored(cls, memory: AlarmMemory, now: float) -> Alarm:
        """The alarm as it was; a delay that was running begins anew."""
        alarm = cls()
        alarm.present, alarm.active = memory.present, memory.active
        alarm.raised, alarm.acknowledged = memory.raised, memory.acknowledged
        alarm.occurrences = memory.occurrences
        alarm.since = now - memory.age if memory.occurrences else math.nan
        alarm._changed = now
        return alarm

    def _raise(self, now: float) -> None:
        self.raised, self.acknowledged = True, False
        self.occurrences += 1
        self.since = now

    def _settle(self, latch: bool) -> None:
        """Return to normal by itself where nothing holds the alarm."""
        if self.acknowledged and not (self.active or latch):
            self.reset()
