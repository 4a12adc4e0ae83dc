"""The alarm's levels, deadband, commands, shelving and sentences."""

import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.tracking.measurements import UNSEEN
from sfd_hbm_ros.response.warning.advice import advice
from sfd_hbm_ros.response.warning.alarm import AlarmState
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.limits import (
    ECCENTRICITY,
    MARGIN,
    MARGIN_PERCENT,
    MEASURED,
    TIME,
    Approach,
)
from sfd_hbm_ros.response.warning.outlook import Change, JumpAhead, Outlook, unknown_outlook
from sfd_hbm_ros.response.warning.rounding import Rounding
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

RPM = np.pi / 30.0
JUMP = 4000.0  # rpm
PROMPT = AlarmSettings(
    margin_warn_rpm=60.0, margin_error_rpm=20.0, deadband=0.1, on_delay=0.0, off_delay=0.0
)
LATCHED = dataclasses.replace(PROMPT, latch=True)


def below_a_jump(margin, acceleration=0.0, after=0.93):
    """A machine at a distance [rpm] below a run-up's jump at 4000 rpm, with none below it."""
    run_up = JumpAhead(Direction.RUN_UP, JUMP * RPM, 0.6, after)
    none = JumpAhead(Direction.COAST_DOWN, math.inf)
    return Outlook((JUMP - margin) * RPM, acceleration, False, run_up, none)


def after(settings, *margins, eccentricity=0.5):
    """The alarm after margins [rpm], one a second."""
    alarm = JumpAlarm(settings)
    for now, margin in enumerate(margins):
        alarm.update(below_a_jump(margin), eccentricity, float(now))
    return alarm


def levels(settings, margins):
    alarm, found = JumpAlarm(settings), []
    for now, margin in enumerate(margins):
        alarm.update(below_a_jump(margin), 0.5, float(now))
        found.append(alarm.level(float(now)))
    return found


O, W, E = Level  # noqa: E741, the levels in a row


def test_levels_by_the_margin():
    """Entered below 60 and 20 rpm, left above 66 and 22 rpm."""
    margins = [61.0, 59.0, 65.0, 21.0, 19.0, 21.0, 23.0, 65.0, 67.0]
    assert levels(PROMPT, margins) == [O, W, W, W, E, E, W, W, O]


@pytest.mark.parametrize(
    ("settings", "outlook", "eccentricity", "level"),
    [
        ({"margin_warn_percent": 2.1}, below_a_jump(80.0), 0.5, W),  # 80 of 3920 are 2.04 %
        ({"margin_warn_percent": 2.0}, below_a_jump(80.0), 0.5, O),
        ({"margin_error_percent": 2.1}, below_a_jump(80.0), 0.5, E),
        ({}, below_a_jump(290.0, 10.0 * RPM), 0.5, W),  # 29 s
        ({}, below_a_jump(310.0, 10.0 * RPM), 0.5, O),
        ({}, below_a_jump(95.0, 10.0 * RPM), 0.5, E),
        ({}, below_a_jump(95.0, -10.0 * RPM), 0.5, O),
        ({}, below_a_jump(1000.0), 0.91, W),
        ({}, below_a_jump(1000.0), 0.96, E),
        ({"eccentricity_warn": 0.0, "eccentricity_error": 0.0}, below_a_jump(1000.0), 0.96, O),
        ({"margin_warn_rpm": 0.0, "margin_error_rpm": 0.0}, below_a_jump(0.0), 0.5, O),
        ({}, below_a_jump(1000.0), math.nan, O),
        ({}, unknown_outlook(400.0, 1.0), math.nan, O),
    ],
)
def test_each_threshold(settings, outlook, eccentricity, level):
    alarm = JumpAlarm(dataclasses.replace(PROMPT, **settings))
    alarm.update(outlook, eccentricity, 0.0)
    assert alarm.level(0.0) is level


@pytest.mark.parametrize(("measured", "level"), [(0.5, O), (0.91, W), (0.96, E), (math.nan, O)])
def test_the_measured_eccentricity_has_the_same_limits(measured, level):
    alarm = JumpAlarm(PROMPT)
    alarm.update(below_a_jump(1000.0), 0.31, 0.0, {MEASURED.name: measured})
    assert alarm.level(0.0) is level
    assert [cause.limit for cause in alarm.causes(0.0)] == ([MEASURED] if level else [])
    alarm.update(below_a_jump(1000.0), 0.31, 1.0, {MEASURED.name: -math.inf})
    assert alarm.level(1.0) is O  # as nothing is measured any more


@pytest.mark.parametrize(
    ("margin", "eccentricity", "measured", "level"),
    [
        (1000.0, 0.31, 0.5, W),
        (10.0, 0.31, 0.5, W),
        (10.0, 0.97, 0.5, W),
        (1000.0, 0.31, 0.96, E),
        (10.0, 0.97, math.nan, W),
    ],
)
@pytest.mark.parametrize("before", [1000.0, 10.0])
def test_while_the_model_is_doubted_it_warns_and_reports_no_error(
    before, margin, eccentricity, measured, level
):
    alarm = after(PROMPT, before)
    given = below_a_jump(margin), eccentricity, 1.0, {MEASURED.name: measured}
    alarm.update(*given, doubtful=True)
    assert alarm.level(1.0) is level
    seen = UNSEEN._replace(disagreement=1.1, differs=True, threshold=0.15)
    sentence = advice(alarm, below_a_jump(margin), eccentricity, 1.0, seen=seen)
    told = "Doubtful, as model and machine differ by about 110 %, the limit is 15 %: "
    assert sentence.startswith(told)


def test_what_is_not_computable_ends_no_alarm():
    alarm, unknown = after(PROMPT, 10.0), unknown_outlook(400.0, math.nan)
    alarm.update(unknown, math.nan, 1.0)
    assert alarm.level(1.0) is Level.ERROR
    assert advice(alarm, unknown, math.nan, 1.0) == (
        "It is not known whether a jump lies ahead; the margin to the jump was 10 rpm when last "
        "known, its limit is 20 rpm; to be acknowledged"
    )


def test_an_alarm_of_one_quantity_is_not_held_by_the_deadband_of_another():
    """Raised by the time in a fast ramp, it ends at a steady speed, at eccentricity 0.877."""
    alarm = JumpAlarm(AlarmSettings())
    for now in np.arange(0.0, 10.0, 0.1).tolist():
        alarm.update(below_a_jump(1500.0, 250.0 * RPM), 0.877, now)
    assert below_a_jump(1500.0, 250.0 * RPM).time_to_jump == pytest.approx(6.0)
    assert alarm.level(10.0) is Level.ERROR
    [cause] = alarm.causes(10.0)
    assert (cause.limit, cause.threshold) == (TIME, 10.0)
    steady = below_a_jump(1361.0)
    for now in np.arange(10.0, 3610.0, 0.5).tolist():
        alarm.update(steady, 0.877, now)
        if alarm.level(now) is not Level.OK:
            assert now < 12.6
            assert "; no limit is passed any more, ERROR ends in less than " in advice(
                alarm, steady, 0.877, now
            )
    assert alarm.state(3610.0) is AlarmState.RETURNED


QUANTITIES = st.fixed_dictionaries(
    {
        MARGIN.name: st.floats(0.0, 200.0) | st.sampled_from([math.inf, math.nan]),
        MARGIN_PERCENT.name: st.floats(0.0, 10.0) | st.sampled_from([math.inf, math.nan]),
        TIME.name: st.floats(0.0, 60.0) | st.sampled_from([math.inf, math.nan]),
        ECCENTRICITY.name: st.floats(0.6, 1.0) | st.just(math.nan),
    }
)
#: Where each limit of WARN and ERROR stands, and what a reading must pass to be behind it.
STANDING = {
    MARGIN.name: ((60.0, 1.1 * 60.0), (20.0, 1.1 * 20.0)),
    MARGIN_PERCENT.name: ((3.0, 1.1 * 3.0), (1.0, 1.1 * 1.0)),
    TIME.name: ((30.0, 1.1 * 30.0), (10.0, 1.1 * 10.0)),
    ECCENTRICITY.name: ((0.9, 0.9 * 0.9), (0.95, 0.9 * 0.95)),
}


@settings(deadline=None, derandomize=True, database=None)  # an example is many looks
@given(
    steps=st.lists(
        st.one_of(
            st.tuples(QUANTITIES, st.floats(0.0, 5.0)),
            st.sampled_from(["acknowledge", "reset", "restart"]),
        ),
        max_size=30,
    ),
    latch=st.booleans(),
)
def test_no_level_is_held_by_nothing(steps, latch):
    """But by a limit that was passed and not yet left, a delay or the latch, and it says so."""
    limits = AlarmSettings(margin_warn_percent=3.0, margin_error_percent=1.0, latch=latch)
    alarm, now = JumpAlarm(limits), 0.0
    passed = {level: set() for level in (Level.WARN, Level.ERROR)}
    left = dict.fromkeys(passed, -math.inf)  # when the last limit was left
    for step in steps:
        if step == "restart":
            alarm = JumpAlarm.from_dict(limits, json.loads(json.dumps(alarm.to_dict(now))), now)
            left = dict.fromkeys(left, now)  # delays begin anew
        elif isinstance(step, str):
            getattr(alarm, step)()
        else:
            given_now, pause = step
            now += pause
            alarm.update(unknown_outlook(400.0, 1.0), math.nan, now, given_now)
            for level, held in passed.items():
                before = set(held)
                for name, reading in given_now.items():
                    limit, release = STANDING[name][level - 1]
                    sign = 1.0 if name == ECCENTRICITY.name else -1.0
                    if sign * reading > sign * limit:
                        held.add(name)
                    elif sign * reading < sign * release:
                        held.discard(name)
                left[level] = now if before and not held else left[level]
        level = alarm.level(now)
        sentence = advice(alarm, unknown_outlook(400.0, 1.0), math.nan, now)
        if level is Level.OK:
            continue
        assert {cause.limit.name for cause in alarm.causes(now)} == passed[level]
        if passed[level]:
            assert sentence.count("its limit") == len(passed[level])
        elif now < left[level] + limits.off_delay:
            assert f"{level.name} ends in less than" in sentence
        else:
            assert latch
            assert "the warning has gone" in sentence


def test_an_alarm_of_an_older_state_file_names_no_limits():
    """What is known then decides, after the delay."""
    data = after(AlarmSettings(), 10.0, 10.0).to_dict(2.0)
    del data["limits"]
    alarm = JumpAlarm.from_dict(AlarmSettings(), data, 0.0)
    alarm.update(below_a_jump(500.0), 0.5, 0.0)
    assert alarm.level(0.0) is Level.ERROR
    alarm.update(below_a_jump(500.0), 0.5, 3.0)
    assert alarm.level(3.0) is Level.OK


@given(
    deadband=st.floats(0.01, 0.5),
    middle=st.floats(-2.0, 2.0),
    noise=st.lists(st.floats(-0.499, 0.499), min_size=2, max_size=60),
)
def test_noise_within_the_deadband_never_toggles(deadband, middle, noise):
    """Wherever it is centred about the threshold of 60 rpm, there is one change at most."""
    settings = dataclasses.replace(PROMPT, deadband=deadband, margin_error_rpm=0.0)
    width = 60.0 * deadband
    found = levels(settings, [60.0 + width * (middle + one) for one in noise])
    assert np.count_nonzero(np.diff(found)) <= 1


@given(
    changes=st.lists(
        st.one_of(
            st.floats(0.0, 200.0), st.sampled_from(["acknowledge", "reset", "shelve", "unshelve"])
        ),
        max_size=40,
    )
)
def test_a_latched_level_never_falls_without_acknowledgement_and_reset(changes):
    alarm, now = JumpAlarm(LATCHED), 0.0
    worst, acknowledged = Level.OK, True
    for change in changes:
        now += 1.0
        if isinstance(change, float):
            alarm.update(below_a_jump(change), 0.5, now)
            entered = Level.ERROR if change < 20.0 else Level.WARN if change < 60.0 else Level.OK
            if entered > worst:
                acknowledged = False
            worst = max(worst, entered)
        elif change == "acknowledge":
            acknowledged = alarm.acknowledge().done
        elif change == "reset":
            if alarm.reset().done:
                assert acknowledged
                worst = Level.OK
        elif change == "shelve":
            alarm.shelve(now)
        else:
            alarm.unshelve()
        hidden = alarm.shelved_for(now) > 0.0
        assert alarm.level(now) == (Level.OK if hidden else worst)


def test_reset_needs_inactive_and_acknowledged():
    alarm = after(LATCHED, 10.0)
    assert alarm.reset() == (False, "refused, since the alarm is still active")
    alarm.update(below_a_jump(500.0), 0.5, 1.0)
    assert alarm.reset() == (False, "refused, since the alarm must be acknowledged first")
    assert alarm.acknowledge() == (True, "acknowledged")
    assert alarm.level(1.0) is Level.ERROR
    assert alarm.reset() == (True, "reset")
    assert alarm.level(1.0) is Level.OK
    assert alarm.acknowledge() == (True, "there was nothing to acknowledge")
    assert alarm.reset() == (True, "there was nothing to reset")


def test_an_error_after_an_acknowledged_warning_is_to_be_acknowledged_too():
    alarm = after(PROMPT, 50.0)
    alarm.acknowledge()
    assert alarm.state(0.0) is AlarmState.ACKNOWLEDGED
    alarm.update(below_a_jump(10.0), 0.5, 5.0)
    assert alarm.state(5.0) is AlarmState.UNACKNOWLEDGED
    assert (alarm.leading.since, alarm.leading.occurrences) == (5.0, 1)


@given(
    shelf_time=st.floats(0.1, 9e4),
    commands=st.lists(st.tuples(st.floats(0.0, 1e3), st.booleans()), min_size=1, max_size=20),
)
def test_shelving_always_expires(shelf_time, commands):
    """At the latest a shelf time after it was last asked for, with or without a restart."""
    settings = dataclasses.replace(PROMPT, shelf_time=shelf_time)
    alarm, now = after(settings, 10.0), 0.0
    for pause, restart in commands:
        now += pause
        alarm.shelve(now)
        if restart:
            alarm = JumpAlarm.from_dict(settings, alarm.to_dict(now), now)
        assert alarm.level(now) is Level.OK
        assert alarm.state(now) is AlarmState.SHELVED
    assert alarm.shelved_for(now + 0.5 * shelf_time) > 0.0
    assert alarm.level(np.nextafter(now + shelf_time, math.inf)) is Level.ERROR


def test_an_alarm_raised_on_the_shelf_shows_when_that_ends():
    alarm = JumpAlarm(PROMPT)
    alarm.shelve(0.0)
    alarm.update(below_a_jump(10.0), 0.5, 1.0)
    assert alarm.level(1.0) is Level.OK
    alarm.unshelve()
    assert alarm.level(1.0) is Level.ERROR
    assert alarm.state(1.0) is AlarmState.UNACKNOWLEDGED


@given(
    margins=st.lists(st.floats(0.0, 100.0), max_size=20),
    acknowledged=st.booleans(),
    shelved=st.booleans(),
    further=st.lists(st.floats(0.0, 100.0), min_size=1, max_size=10),
)
def test_state_survives_a_restart(margins, acknowledged, shelved, further):
    """Through text, and to a process whose clock reads otherwise."""
    alarm = after(LATCHED, *margins)
    now, later = float(len(margins)), 7e4
    if acknowledged:
        alarm.acknowledge()
    if shelved:
        alarm.shelve(now)
    data = json.loads(json.dumps(alarm.to_dict(now), allow_nan=False))
    restored = JumpAlarm.from_dict(LATCHED, data, later)
    assert restored.to_dict(later) == alarm.to_dict(now)
    for margin in further:
        now, later = now + 1.0, later + 1.0
        for one, time in ((alarm, now), (restored, later)):
            one.update(below_a_jump(margin), 0.5, time)
        assert restored.state(later) is alarm.state(now)
        assert restored.level(later) is alarm.level(now)
        assert restored.reset() == alarm.reset()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"warn": None}, "warn must be a mapping with the keys present, active, .* not nothing"),
        ({"error": {}}, "error.present is missing: whether the condition held"),
        ({"limits": {"warn": 3}}, "limits.warn must be a mapping, not 3"),
        ({"limits": {"error": {"time": "1"}}}, "limits.error.time must be a finite number, not"),
        ({"shelf": {"remaining": -1.0}}, r"shelf.remaining must be a finite number \[s\] of at"),
        ({"shelf": {"remaining": math.inf}}, r"shelf.remaining must be a finite number \[s\] of"),
    ],
)
def test_foreign_state_is_refused(change, sentence):
    data = JumpAlarm(PROMPT).to_dict(0.0) | change
    with pytest.raises(MachineError, match=sentence):
        JumpAlarm.from_dict(PROMPT, data, 0.0)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        (
            {"margin_error_rpm": 60.0},
            "margin_error_rpm must be below margin_warn_rpm, 60 rpm, or 0 for none, not 60",
        ),
        (
            {"margin_warn_percent": 1.0, "margin_error_percent": 2.0},
            "margin_error_percent must be below margin_warn_percent, 1 % of the speed, or 0",
        ),
        ({"time_error": 31.0}, "time_error must be below time_warn, 30 s, or 0 for none, not 31"),
        (
            {"eccentricity_error": 0.8},
            "eccentricity_error must be above eccentricity_warn, 0.9 of the clearance, or 0",
        ),
        ({"deadband": -0.1}, "deadband must be a finite number of at least 0 and below 1, not"),
        ({"on_delay": -1.0}, r"on_delay must be a finite number \[s\] of at least 0 and below"),
        ({"off_delay": math.nan}, r"off_delay must be a finite number \[s\] of at least 0"),
        ({"shelf_time": 0.0}, r"shelf_time must be a finite number \[s\] above 0 and below"),
        ({"time_warn": "soon"}, r"time_warn must be a finite number \[s\] of at least 0, not 's"),
        ({"latch": 3}, "latch must be true or false, not 3"),
    ],
)
def test_bad_settings_are_refused(settings, sentence):
    with pytest.raises(MachineError, match=sentence):
        dataclasses.replace(PROMPT, **settings)


@pytest.mark.parametrize("warn", [0.0, 60.0])
def test_either_threshold_can_be_left_out(warn):
    settings = dataclasses.replace(PROMPT, margin_warn_rpm=warn, margin_error_rpm=60.0 - warn)
    assert settings.threshold("margin_{}_rpm", Level.WARN) == warn


SPEED = 3950.0 * RPM
UP = JumpAhead(Direction.RUN_UP, 3985.0 * RPM, 0.62, 0.93)
DOWN = JumpAhead(
    Direction.COAST_DOWN,
    3905.0 * RPM,
    0.8,
    0.7,
    (Change("de", 0.8, 0.42), Change("nde", 0.6, 0.7)),
)
OFF = JumpAhead(Direction.COAST_DOWN, 3905.0 * RPM, 0.99)
NONE = JumpAhead(Direction.RUN_UP, math.inf)


@pytest.mark.parametrize(
    ("outlook", "sentence"),
    [
        (
            Outlook(SPEED, 3.0 * RPM, True, UP, DOWN),
            "Jump up to eccentricity 0.93 expected at 3985 rpm, in "
            "less than 20 s at the present acceleration",
        ),
        (
            Outlook(SPEED, -20.0 * RPM, True, UP, DOWN),
            "Jump of de down to eccentricity 0.42 expected at 3905 rpm, in "
            "less than 5 s at the present acceleration",
        ),
        (
            Outlook(SPEED, -20.0 * RPM, True, UP, DOWN, settled=False),
            "Jump of de down to eccentricity 0.42 expected at 3905 rpm, less than 50 rpm "
            "below the present speed",
        ),
        (
            Outlook(SPEED, 0.0, True, UP, DOWN),
            "Jump up to eccentricity 0.93 expected at 3985 rpm, less than 50 rpm above the "
            "present speed",
        ),
        (
            Outlook(SPEED, math.nan, False, NONE, OFF),
            "Jump to an unknown response expected at 3905 rpm, less than 50 rpm below the present "
            "speed",
        ),
        (Outlook(SPEED, 1.0, False, NONE, DOWN), "No jump ahead"),
        (
            Outlook(SPEED, 1.0, True, NONE, DOWN),
            "No jump ahead; another stable response exists at this speed",
        ),
        (unknown_outlook(SPEED, 1.0), "It is not known whether a jump lies ahead"),
        (
            Outlook(
                SPEED,
                0.0,
                True,
                UP,
                OFF,
                eccentricity=0.8,
                others=(Outlook(SPEED, 0.0, True, NONE, NONE, eccentricity=0.6),),
            ),
            "It is not known on which of 2 responses the machine is: either at eccentricity 0.60, "
            "no jump ahead, or at eccentricity 0.80, jump up to eccentricity 0.93 expected at "
            "3985 rpm, less than 50 rpm above the present speed; an orbit on ~/measured would "
            "settle it",
        ),
    ],
)
def test_sentence_for_each_outlook(outlook, sentence):
    assert advice(JumpAlarm(PROMPT), outlook, 0.5, 0.0) == sentence


def test_sentence_for_each_state():
    alarm, far = after(LATCHED, 9.0), below_a_jump(500.0, -1.0)
    near = "Jump up to eccentricity 0.93 expected at 4000 rpm, less than 10 rpm above the "
    near += "present speed; the margin to the jump is below its limit of 20 rpm"
    assert advice(alarm, below_a_jump(9.0), 0.5, 0.0) == f"{near}; to be acknowledged"
    alarm.acknowledge()
    assert advice(alarm, below_a_jump(9.0), 0.5, 0.0) == f"{near}; acknowledged"
    alarm.update(far, 0.5, 1.0)
    gone = "No jump ahead; the warning has gone, is acknowledged and to be reset"
    assert advice(alarm, far, 0.5, 1.0) == gone
    alarm.shelve(1.0)
    assert advice(alarm, far, 0.5, 1.0) == "No jump ahead; shelved for less than 10 min more"
    alarm = after(LATCHED, 10.0, 500.0)
    gone = "No jump ahead; the warning has gone and is to be acknowledged"
    assert advice(alarm, far, 0.5, 1.0) == gone


@given(
    noise=st.lists(st.floats(-0.5, 0.5), min_size=2, max_size=30),
    margin=st.floats(5.0, 2000.0),
    acceleration=st.floats(0.05, 30.0),
)
def test_a_sentence_does_not_flicker(noise, margin, acceleration):
    """Of a machine whose speed breathes by half a rpm; its numbers are never overstated."""
    rounding, alarm = Rounding(), JumpAlarm(PROMPT)
    said = set()
    for one in noise:
        outlook = below_a_jump(margin + 0.1 * one, acceleration)
        said.add(advice(alarm, outlook, 0.5, 0.0, rounding))
        for words, actual in (
            (rounding.within_rpm("m", margin + 0.1 * one), margin + 0.1 * one),
            (rounding.within_time("t", outlook.time_to_jump), outlook.time_to_jump),
        ):
            if words != "more than an hour":
                _, _, number, unit = words.split()
                assert actual <= float(number) * (60.0 if unit == "min" else 1.0)
    assert len(said) <= 3  # where both numbers come to a bound, each changes once


def test_an_error_leaves_a_fast_ramp_room_after_its_warning():
    """At 250 rpm/s a jump 1500 rpm ahead is within both limits as soon as the ramp is known."""
    settings, approach = AlarmSettings(), Approach()
    alarm, rose = JumpAlarm(settings), {}
    for now in np.arange(0.0, 6.0, 0.02).tolist():
        outlook = below_a_jump(1500.0 - 250.0 * now, 250.0 * RPM)
        fitted = approach.fitted(settings, outlook.time_to_jump, reported=False)
        alarm.update(outlook, 0.5, now, settings=fitted)
        rose.setdefault(alarm.level(now), now)
    assert rose[Level.WARN] < 0.2
    assert rose[Level.ERROR] == pytest.approx(4.1, abs=0.1)  # 2 s before it, after the delay
    slow = Approach()
    for margin in (400.0, 299.0, 100.0):  # 30 s before it at 10 rpm/s, as the limits have it
        time = below_a_jump(margin, 10.0 * RPM).time_to_jump
        limit = slow.fitted(settings, time, reported=False).time_error
        assert limit == pytest.approx(10.0, rel=0.01)


def test_sentence_near_lock_up():
    outlook = Outlook(SPEED, 1.0, False, NONE, DOWN)
    sentence = "Film near lock-up at eccentricity 0.96. No jump ahead"
    assert advice(JumpAlarm(PROMPT), outlook, 0.96, 0.0) == sentence
