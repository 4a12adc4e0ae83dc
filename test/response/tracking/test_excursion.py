"""Speeds that leap away and are back at once, by hand-made times."""

import math

import pytest

from sfd_hbm_ros.response.tracking.excursion import LEAP, RETURN, Excursion


def returned(*readings: tuple[float, float]) -> list[str | None]:
    """What each reading of a speed and its time returns, if that is known by their number."""
    excursion: Excursion[str] = Excursion()
    return [
        excursion.returned(speed, time, f"before {number}")
        for number, (speed, time) in enumerate(readings)
    ]


@pytest.mark.parametrize("wrong", [0.0, 200.0, 800.0, math.nan])
def test_what_was_known_before_the_leap_returns_with_the_speed(wrong):
    assert returned((400.0, 0.00), (wrong, 0.02), (401.0, 0.04)) == [None, None, "before 1"]


def test_of_several_wrong_speeds_the_first_counts():
    readings = (400.0, 0.00), (200.0, 0.02), (800.0, 0.04), (400.0, 0.06), (401.0, 0.08)
    assert returned(*readings) == [None, None, None, "before 1", None]


def test_speeds_that_differ_by_less_are_no_leap():
    near = 400.0 * (1.0 - LEAP) + 1.0
    assert returned((400.0, 0.0), (near, 0.02), (400.0, 0.04)) == [None] * 3


@pytest.mark.parametrize("back", [1.1 * RETURN, -1.0 - RETURN, math.nan])
def test_a_machine_that_is_back_later_was_there(back):
    """Later, after the clock was set back, or at no known time."""
    assert returned((400.0, 0.0), (800.0, 0.02), (400.0, back)) == [None] * 3
    assert returned((400.0, 0.0), (800.0, back), (400.0, 2.0 * back)) == [None] * 3


def test_a_machine_that_stays_away_begins_anew():
    readings = (400.0, 0.0), (800.0, 0.3), (800.0, 0.6), (400.0, 0.8), (800.0, 1.0)
    assert returned(*readings) == [None, None, None, None, "before 3"]
