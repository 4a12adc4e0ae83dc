"""One alarm against the state diagram of ISA-18.2, under any order of events."""

import dataclasses

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.machine.parts import plain, read
from sfd_hbm_ros.response.warning.alarm import Alarm, AlarmMemory, AlarmState
from sfd_hbm_ros.response.warning.settings import AlarmSettings

TICK = 0.125  # s; times are whole numbers of it, which floats hold exactly

N, U, A, R, L = (
    AlarmState.NORMAL,
    AlarmState.UNACKNOWLEDGED,
    AlarmState.ACKNOWLEDGED,
    AlarmState.RETURNED,
    AlarmState.LATCHED,
)
#: What each event makes of each state; latched alarms differ where "latch" has an entry.
DIAGRAM = {
    "active": {N: U, U: U, A: A, R: U, L: U},
    "inactive": {N: N, U: R, A: N, R: R, L: L},
    "inactive latch": {A: L},
    "acknowledge": {N: N, U: A, A: A, R: N, L: L},
    "acknowledge latch": {R: L},
}


class Reference:
    """The diagram, and delays looked up in a history of every tick."""

    def __init__(self, settings):
        self.settings = settings
        self.state, self.active, self.history = N, False, [False]

    def event(self, name):
        latched = DIAGRAM.get(f"{name} latch", {}) if self.settings.latch else {}
        self.state = (DIAGRAM[name] | latched)[self.state]

    def update(self, present, ticks):
        self.history += [self.history[-1]] * (ticks - 1) + [present] * (ticks > 0)
        self.history[-1] = present
        delay = self.settings.on_delay if present else self.settings.off_delay
        lasting = self.history[-1 - round(delay / TICK) :]
        whole = len(lasting) == 1 + round(delay / TICK)
        if present != self.active and whole and all(one == present for one in lasting):
            self.active = present
            self.event("active" if present else "inactive")


class AlarmMachine(RuleBasedStateMachine):
    @initialize(
        on=st.integers(0, 6), off=st.integers(0, 6), latch=st.booleans(), start=st.integers(0, 99)
    )
    def begin(self, on, off, latch, start):
        self.settings = AlarmSettings(on_delay=on * TICK, off_delay=off * TICK, latch=latch)
        self.alarm, self.reference = Alarm(), Reference(self.settings)
        self.now = start * TICK
        self.raised = []
        self.alarm.update(False, self.now, self.settings)

    @rule(present=st.booleans(), ticks=st.integers(1, 8))
    def update(self, present, ticks):
        self.now += ticks * TICK
        active = self.alarm.active
        self.alarm.update(present, self.now, self.settings)
        self.reference.update(present, ticks)
        if self.reference.active and not active:
            self.raised.append(self.now)

    @rule()
    def acknowledge(self):
        self.alarm.acknowledge(self.settings.latch)
        self.reference.event("acknowledge")

    @rule()
    def reset(self):
        if self.alarm.state is AlarmState.LATCHED:
            self.alarm.reset()
            self.reference.state = N

    @rule()
    def forget_and_remember(self):
        """What was delayed begins anew, so only a quiet alarm goes on as if nothing had been."""
        if self.alarm.present == self.alarm.active:
            data = plain(self.alarm.memory(self.now))
            self.alarm = Alarm.restored(read(AlarmMemory, data, ""), self.now)

    @invariant()
    def agrees(self):
        if hasattr(self, "alarm"):
            assert self.alarm.state is self.reference.state
            assert self.alarm.active == self.reference.active
            assert self.alarm.occurrences == len(self.raised)
            if self.raised:
                assert self.alarm.since == self.raised[-1]


TestAlarmMachine = AlarmMachine.TestCase


def test_delays_pass_at_the_first_look_after_their_end():
    settings = AlarmSettings(on_delay=1.0, off_delay=3.0)
    alarm = Alarm()
    for now, present, active in (
        (10.0, True, False),
        (10.999, True, False),
        (11.0, True, True),
        (20.0, False, True),
        (22.0, True, True),
        (23.0, False, True),
        (25.999, False, True),
        (26.0, False, False),
    ):
        alarm.update(present, now, settings)
        assert alarm.active is active
    assert (alarm.since, alarm.occurrences) == (11.0, 1)


def test_a_latched_alarm_is_freed_by_settings_that_do_not_latch():
    settings = AlarmSettings(on_delay=0.0, off_delay=0.0, latch=True)
    alarm = Alarm()
    alarm.update(True, 0.0, settings)
    alarm.update(False, 1.0, settings)
    alarm.acknowledge(latch=True)
    assert alarm.state is AlarmState.LATCHED
    alarm.update(False, 2.0, dataclasses.replace(settings, latch=False))
    assert alarm.state is AlarmState.NORMAL


def test_reset_of_an_active_alarm_is_a_mistake_of_the_caller():
    alarm = Alarm()
    alarm.update(True, 0.0, AlarmSettings(on_delay=0.0))
    with pytest.raises(AssertionError):
        alarm.reset()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"occurrences": -1}, "warn.occurrences must be an integer of at least 0, not -1"),
        ({"active": 7}, "warn.active must be true or false, not 7"),
        ({"age": float("nan")}, r"warn.age must be a finite number \[s\] of at least 0, not nan"),
    ],
)
def test_foreign_memories_are_refused(change, sentence):
    data = plain(Alarm().memory(0.0)) | change
    with pytest.raises(MachineError, match=sentence):
        read(AlarmMemory, data, "warn")
