"""The jumps that a machine made, as its predictions show them: counted, told and remembered."""

import json
import math
import re
import time
from dataclasses import replace
from functools import cache

import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import MachineError, override
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.warning.jump_log import JumpLog
from sfd_hbm_ros.response.warning.jump_map import jump_map

from ...hbm.machines import PAPER

RPM = math.pi / 30.0
NOON = time.mktime((2026, 11, 28, 18, 2, 11, 0, 0, -1))  # 18:02:11 by the local clock


@cache
def curve():
    """It jumps at 4160 rpm on the way up and at 3985 rpm on the way down."""
    balance = HarmonicBalance(
        override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4), Harmonics(1)
    )
    return response_curve(balance, 3800.0 * RPM, 4300.0 * RPM)


def tracker():
    found = Tracker(curve().balance)
    found.adopt(curve())
    return found


def run(log, tracker, speeds, begin=NOON, step=0.02):
    """Follow speeds [rpm], 50 a second."""
    ahead, jumps = None, jump_map(curve())
    for number, rpm in enumerate(speeds):
        now = begin + step * number
        tracked = tracker.predict(rpm * RPM, now)
        assert tracked.solution.converged
        log.take(tracked, now, ahead)
        ahead = jumps.outlook(tracked.place, 1.0) if tracked.place else None
    return now


def test_a_jump_is_told_counted_and_kept_until_it_is_acknowledged():
    log, machine = JumpLog(), tracker()
    now = run(log, machine, range(3850, 4200, 5))
    assert (log.count, log.unseen) == (1, 1)
    sentence = log.sentence(now)
    assert sentence.startswith("damper_1 jumped down at 4160 rpm, 0.9")
    assert sentence.endswith(" to 0.32, at 18:02:12. ")
    assert " on 2026-11-28. " in log.sentence(now + 86400.0)
    run(log, machine, range(4200, 3900, -5), now + 1.0)
    assert log.count == 2
    assert "damper_1 jumped up at 3985 rpm, 0.5" in log.sentence(now)
    assert log.sentence(now).endswith(", the last of 2 jumps. ")
    restored = JumpLog.from_dict(json.loads(json.dumps(log.to_dict(), allow_nan=False)))
    assert restored.to_dict() == log.to_dict()
    assert restored.sentence(now) == log.sentence(now)
    up, down = restored.rows
    assert re.match(r"2026-11-2[789]T\d\d:02:1\dZ damper_1 jumped down at 4160 rpm, 0\.9", down)
    assert " damper_1 jumped up at 3985 rpm" in up
    assert log.acknowledge()
    assert not log.acknowledge()
    assert (log.sentence(now), log.count) == ("", 2)


def test_a_speed_that_was_wrong_is_no_jump():
    log, machine = JumpLog(), tracker()
    run(log, machine, [4100.0, 4110.0, 8220.0, 4120.0, 4125.0, 2060.0, 4130.0])
    assert log.count == 0


def test_a_machine_that_is_found_on_the_other_response_has_jumped():
    log, machine = JumpLog(), tracker()
    now = run(log, machine, range(3850, 4100, 5))
    tracked = machine.predict(4095.0 * RPM, now)
    assert tracked.branch is BranchName.UPPER
    machine.settle(tracked.other)
    run(log, machine, [4095.0], now + 0.02)
    assert "damper_1 jumped down at 4095 rpm, 0.8" in log.sentence(now)


def test_an_assumed_machine_has_not_jumped():
    """Begun amid the bistable range, it may not have been where it jumps from."""
    log, machine = JumpLog(), tracker()
    run(log, machine, range(4100, 4200, 5))
    assert log.count == 0


def test_what_is_not_seen_is_no_jump():
    log, machine = JumpLog(), tracker()
    run(log, machine, range(3850, 4100, 5))
    log.lose_sight()
    run(log, machine, [4200.0], NOON + 60.0)
    assert log.count == 0


def test_only_the_last_ten_are_kept():
    log, machine = JumpLog(), tracker()
    run(log, machine, [4100.0, 4200.0] * 2 + [3850.0, 4100.0, 4200.0] * 12, step=1.0)
    assert log.count > 10 == len(log.last)
    assert JumpLog.from_dict(log.to_dict()).to_dict() == log.to_dict()


@pytest.mark.parametrize(
    "change",
    [{"count": -1}, {"unseen": 9}, {"last": [{}]}, {"last": None}, {"count": 0}],
)
def test_foreign_logs_are_refused(change):
    log = JumpLog()
    run(log, tracker(), [3850.0, 4100.0, 4200.0], step=1.0)
    assert JumpLog.from_dict({}).count == 0
    with pytest.raises((MachineError, TypeError, ValueError)):
        JumpLog.from_dict(log.to_dict() | change)
    with pytest.raises(MachineError):
        replace(log.last[0], time=math.inf)


@pytest.mark.parametrize(
    ("origin", "branch"), [(3850.0 * RPM, BranchName.LOWER), (4100.0 * RPM, BranchName.UNKNOWN)]
)
def test_what_was_not_settled_goes_on_after_a_restart(origin, branch):
    """On the response where it landed, though there is no curve that tells its branch."""
    machine = tracker()
    for rpm in (4100.0, 4200.0, 4120.0):
        tracked = machine.predict(rpm * RPM)
    again = Tracker(curve().balance)
    again.assume(tracked.solution, origin)
    assert (again.settled, again.origin) == (False, origin)
    there = again.predict(4110.0 * RPM)
    assert there.branch is BranchName.UNKNOWN
    assert there.solution.eccentricity_max < 0.4
    again.adopt(curve())
    assert again.predict(4110.0 * RPM).branch is branch
