"""The warning of a jump: its level, its keys, and numbers that are infinite or not known."""

import math

import pytest

from sfd_hbm_ros.node.jump_status import jump_status
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.outlook import JumpAhead, Outlook, unknown_outlook
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

RPM = math.pi / 30.0
SETTINGS = AlarmSettings(
    margin_warn_rpm=100.0, margin_error_rpm=10.0, on_delay=0.0, off_delay=0.0, deadband=0.0
)


def outlook(rpm: float, acceleration: float = 2.0 * RPM) -> Outlook:
    """On a branch that folds at 4000 rpm upwards and at 3900 rpm downwards."""
    up = JumpAhead(Direction.RUN_UP, 4000.0 * RPM, 0.7, 0.2)
    down = JumpAhead(Direction.COAST_DOWN, 3900.0 * RPM, 0.5, 0.8)
    return Outlook(rpm * RPM, acceleration, True, up, down)


def test_a_jump_ahead():
    alarm, ahead = JumpAlarm(SETTINGS), outlook(3950.0)
    alarm.update(ahead, 0.6, 10.0)
    status = jump_status(alarm, ahead, BranchName.UPPER, 0.6, 3.0, 12.5)
    assert (status.subject, status.level) == ("Jump", Level.WARN)
    assert "4000 rpm" in status.message
    assert status.values == {
        "branch": "upper",
        "bistable": "true",
        "next_jump": "run_up",
        "next_jump_rpm": "4000",
        "next_jump_damper": "",
        "margin_rpm": "50",
        "margin_percent": "1.26582",
        "time_to_jump_s": "25",
        "eccentricity": "0.6",
        "measured_eccentricity": "nan",
        "measured_disagreement": "nan",
        "doubtful": "false",
        "eccentricity_after": "0.2",
        "run_up_jump_rpm": "4000",
        "coast_down_jump_rpm": "3900",
        "possible": "",
        "alarm": "active, unacknowledged",
        "since_s": "2.5",
        "held_by": "margin to the jump 50 rpm, limit 100 rpm, beyond the limit; "
        "time to the jump 25 s, limit 30 s, beyond the limit",
        "occurrences": "1",
        "model_age_s": "3",
    }


@pytest.mark.parametrize(
    ("rpm", "acceleration", "level", "next_jump"),
    [
        (3995.0, 2.0, Level.ERROR, "run_up"),
        (3995.0, -2.0, Level.WARN, "coast_down"),
        (3905.0, -2.0, Level.ERROR, "coast_down"),
    ],
)
def test_the_level_is_that_of_the_alarm(rpm, acceleration, level, next_jump):
    alarm, ahead = JumpAlarm(SETTINGS), outlook(rpm, acceleration * RPM)
    alarm.update(ahead, 0.6, 10.0)
    status = jump_status(alarm, ahead, BranchName.UPPER, 0.6, 0.0, 10.0)
    assert (status.level, status.values["next_jump"]) == (level, next_jump)


def test_none_ahead_is_infinite_and_unknown_is_not_a_number():
    alarm = JumpAlarm(SETTINGS)
    up, down = (JumpAhead(direction, math.inf) for direction in Direction)
    none = Outlook(300.0, math.nan, False, up, down)
    alarm.update(none, 0.1, 1.0)
    values = jump_status(alarm, none, BranchName.SINGLE, 0.1, 0.0, 1.0).values
    for key in ("margin_rpm", "margin_percent", "next_jump_rpm", "run_up_jump_rpm"):
        assert float(values[key]) == math.inf
    assert values["bistable"] == "false"
    assert math.isnan(float(values["since_s"]))
    unknown = unknown_outlook(300.0, math.nan)
    alarm.update(unknown, math.nan, 2.0)
    status = jump_status(alarm, unknown, BranchName.UNKNOWN, math.nan, math.inf, 2.0)
    assert status.level == Level.OK
    for key in ("margin_rpm", "time_to_jump_s", "eccentricity", "coast_down_jump_rpm"):
        assert math.isnan(float(status.values[key]))
    assert (status.values["branch"], status.values["bistable"]) == ("unknown", "unknown")
