import math

import numpy as np
import pytest
from scipy.integrate import quad

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile

PROFILE = SpeedProfile(from_rpm=2000.0, to_rpm=6000.0, rpm_per_second=250.0, hold=2.0)
RPM = math.pi / 30.0  # rad/s


@pytest.mark.parametrize(
    ("time", "rpm"),
    [(-5, 2000), (0, 2000), (4, 3000), (16, 6000), (18, 6000), (24, 4500), (34, 2000), (40, 2000)],
)
def test_speed_follows_the_legs(time: float, rpm: float) -> None:
    assert PROFILE.speed(time) == pytest.approx(rpm * RPM, rel=1e-12)


def test_duration_is_two_legs_and_the_hold() -> None:
    assert PROFILE.duration == pytest.approx(16.0 + 2.0 + 16.0)


def test_speed_is_continuous() -> None:
    times = np.linspace(-1.0, 35.0, 36_001)
    speeds = [PROFILE.speed(time) for time in times]
    assert np.abs(np.diff(speeds)).max() == pytest.approx(250.0 * RPM * 1e-3, rel=1e-6)


@pytest.mark.parametrize("time", [-2.0, 3.0, 16.0, 17.5, 18.0, 25.0, 34.0, 36.0])
def test_angle_is_the_integral_of_the_speed(time: float) -> None:
    kinks = [t for t in (0.0, 16.0, 18.0, 34.0) if t < time]
    expected, _ = quad(PROFILE.speed, 0.0, time, points=kinks or None)
    assert PROFILE.angle(time) == pytest.approx(expected, rel=1e-12)


def test_equal_speeds_make_a_constant_speed() -> None:
    steady = SpeedProfile(from_rpm=3000.0, to_rpm=3000.0, hold=5.0)
    assert steady.duration == 5.0
    assert [steady.speed(time) for time in (0.0, 2.5, 5.0)] == [pytest.approx(100.0 * math.pi)] * 3


def test_runs_follow_each_other() -> None:
    two = SpeedProfile(runs=2)
    assert two.duration == pytest.approx(68.0)
    times = np.linspace(0.0, 34.0, 100, endpoint=False)
    for time in times:
        assert two.speed(34.0 + time) == pytest.approx(PROFILE.speed(time), rel=1e-9)
    expected, _ = quad(two.speed, 0.0, 50.0, points=[16.0, 18.0, 34.0, 50.0])
    assert two.angle(50.0) == pytest.approx(expected, rel=1e-12)
    assert two.speed(70.0) == pytest.approx(2000.0 * RPM)


@pytest.mark.parametrize("time", [0.4, 15.9, 17.0, 33.5, 40.0])
def test_time_belongs_to_its_angle(time: float) -> None:
    profile = SpeedProfile(runs=2)
    assert profile.time(profile.angle(time), time - 0.02) == pytest.approx(time, rel=1e-12)


@pytest.mark.parametrize(
    ("key", "value", "unit"),
    [
        ("from_rpm", -3.0, "[rpm]"),
        ("from_rpm", math.nan, "[rpm]"),
        ("to_rpm", math.inf, "[rpm]"),
        ("rpm_per_second", 0.0, "[rpm/s]"),
        ("rpm_per_second", "fast", "[rpm/s]"),
        ("hold", -1.0, "[s]"),
    ],
)
def test_a_bad_value_is_named_with_its_unit(key: str, value: object, unit: str) -> None:
    with pytest.raises(MachineError) as caught:
        SpeedProfile(**{key: value})  # type: ignore[arg-type]
    sentence = str(caught.value)
    assert sentence.startswith(f"{key} must be ")
    assert unit in sentence
    assert repr(value) in sentence


def test_the_top_must_not_lie_below_the_start() -> None:
    with pytest.raises(MachineError, match="to_rpm must be at least from_rpm, 2000 rpm, not 1500"):
        SpeedProfile(to_rpm=1500.0)
