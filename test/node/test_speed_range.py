"""The range of the response curve: from the machine's file, followed, and speeds sent in rpm."""

import math

import pytest

from sfd_hbm_ros.node.speed_range import LOWEST, WIDEST, SpeedRange, outside

RPM = math.pi / 30.0  # rad/s


def configured(*operating: float) -> SpeedRange:
    speeds = SpeedRange()
    speeds.configure(50.0, 1000.0, operating)
    return speeds


def held(speeds: SpeedRange, speed: float, acceleration: float = 0.0) -> tuple[float, float]:
    """The range after three seconds at a speed."""
    for now in range(31):
        speeds.follow(speed, acceleration, 0.1 * now)
    return speeds.lowest, speeds.highest


@pytest.mark.parametrize(
    ("speed", "acceleration", "expected"),
    [
        (900.0, 0.0, (50.0, 1000.0)),
        (900.0, math.nan, (50.0, 1000.0)),
        (1200.0, math.nan, (50.0, 1800.0)),
        (990.0, 100.0, (50.0, 1990.0)),  # 10 s ahead, as it would leave the range within 5 s
        (5000.0, 0.0, (50.0, WIDEST * 1000.0)),
        (20.0, 0.0, (LOWEST, 1000.0)),
        (60.0, -10.0, (LOWEST, 1000.0)),
    ],
)
def test_it_follows_the_speed_within_bounds(speed, acceleration, expected):
    assert held(configured(), speed, acceleration) == expected


def test_a_single_speed_is_not_followed():
    speeds = configured()
    for now in range(100):
        assert not speeds.follow(5000.0 if now % 5 == 0 else 500.0, 0.0, 0.1 * now)


def test_another_range_is_begun_with_and_the_same_leaves_what_was_widened():
    speeds = configured()
    held(speeds, 1200.0)
    speeds.configure(50.0, 1000.0, ())
    assert speeds.highest == 1800.0
    speeds.configure(50.0, 1100.0, ())
    assert speeds.highest == 1100.0


@pytest.mark.parametrize(
    ("speed", "critical", "operating", "doubted"),
    [
        (900.0, math.nan, (), False),
        (1300.0, math.nan, (), False),
        (3900.0, math.nan, (), True),
        (2500.0, 400.0, (), True),  # six times the first critical speed
        (2500.0, 2000.0, (), False),
        (2000.0, math.nan, (200.0, 600.0), True),
        (2000.0, math.nan, (200.0, 1900.0), False),
        (30000.0, math.nan, (), False),  # it is odd in rpm, too
    ],
)
def test_what_can_only_be_rpm_is_doubted(speed, critical, operating, doubted):
    words = configured(*operating).doubt(speed, critical)
    assert bool(words) is doubted
    if doubted:
        assert f"were {speed:.6g} rpm meant" in words


def test_it_is_told_on_which_side_of_the_curve_a_speed_is():
    assert outside(500.0, 100.0, 1000.0) == ""
    assert "ends at 9549 rpm" in outside(1001.0, 100.0, 1000.0)
    assert "begins at 955 rpm" in outside(99.0, 100.0, 1000.0)
    assert outside(5.0, LOWEST, 1000.0) == ""
