"""The warning of a whole run at the simulator's own rate, as the predictor gives it."""

import math
from itertools import pairwise

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.journey import first_place, travel
from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator
from sfd_hbm_ros.response.warning.advice import advice
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.jump_map import jump_map
from sfd_hbm_ros.response.warning.limits import Approach
from sfd_hbm_ros.response.warning.rounding import Rounding
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

from ...test_package import ROOT

RPM = math.pi / 30.0
RATE = 50.0


@pytest.mark.parametrize("rpm_per_second", [SpeedProfile().rpm_per_second, 25.0])
def test_an_error_follows_its_warning_and_no_text_flickers(rpm_per_second):
    """Up and down through both jumps, with noise; every level says what holds it."""
    machine = read_machine(ROOT / "config" / "jumping_rotor.yaml")
    curve = response_curve(HarmonicBalance(machine, Harmonics(1)), 200.0, 640.0)
    ahead, noise = jump_map(curve), np.random.default_rng(1)
    profile = SpeedProfile(from_rpm=3000.0, to_rpm=5200.0, rpm_per_second=rpm_per_second)
    alarm, approach, estimator = JumpAlarm(AlarmSettings()), Approach(), AccelerationEstimator()
    rounding, place = Rounding(), first_place(curve.branches)
    rose, said = [], []
    for now in np.arange(0.0, profile.duration, 1.0 / RATE).tolist():
        speed = profile.speed(now)
        estimator.add(round(now * 1e9), speed + noise.normal(0.0, 0.02))
        place = travel(curve, place, speed).place
        outlook = ahead.outlook(place, estimator.acceleration, estimator.settled)
        limits = approach.fitted(alarm.settings, outlook.time_to_jump, reported=False)
        alarm.update(outlook, place.eccentricity, now, settings=limits)
        level = alarm.level(now)
        if not rose or rose[-1][1] is not level:
            rose.append((now, level))
        said.append(advice(alarm, outlook, place.eccentricity, now, rounding))
        assert level is Level.OK or "limit" in said[-1]
    levels = [level for _, level in rose]
    assert levels.count(Level.ERROR) == 2  # once for each jump
    for (before, lower), (after, higher) in pairwise(rose):
        if higher is Level.ERROR:
            assert lower is Level.WARN
            assert after - before > 0.5
    changes = sum(one != other for one, other in pairwise(said))
    assert changes <= 40  # over the whole run, at 250 rpm/s in 20 s as at 25 in three minutes
