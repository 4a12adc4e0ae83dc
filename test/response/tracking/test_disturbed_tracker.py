"""The tracker with wrong speeds, and with little time."""

from itertools import count
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfd_hbm_ros.hbm import solve, time_limit
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.tracking.tracker import Tracker

from .test_tracker import HIGHEST, INSIDE, LOWEST, RPM, balance, curve, followed, guided, orbits


@pytest.mark.parametrize("wrong", [0.5, 2.0])
@pytest.mark.parametrize("with_curve", [True, False], ids=["curve", "no curve"])
@pytest.mark.parametrize("times", [1, 3])
def test_wrong_speeds_leave_the_branch_alone(wrong, with_curve, times):
    """Half the speed lies where there is the upper response only, twice the speed the lower."""
    for side, name in ((LOWEST, BranchName.UPPER), (HIGHEST, BranchName.LOWER)):
        tracker = guided() if with_curve else Tracker(balance())
        for i, rpm in enumerate(np.linspace(side, INSIDE, 30)):
            right = tracker.predict(rpm * RPM, 0.02 * i)
        for i in range(times):
            away = tracker.predict((wrong + 0.01 * i) * INSIDE * RPM, 0.6 + 0.02 * i)
            assert away.solution.converged
            assert (right.doubtful, away.doubtful) == (False, True)
        after = tracker.predict((INSIDE + 1.0) * RPM, 0.6 + 0.02 * times)
        expected = orbits(INSIDE + 1.0)[-1 if name == BranchName.UPPER else 0]
        assert after.solution.eccentricity_max == pytest.approx(expected, abs=1e-8)
        assert after.branch == right.branch == (name if with_curve else BranchName.UNKNOWN)
        assert (after.jumped, after.doubtful) == (False, False)
        assert (right.wrong_before, after.wrong_before) == (False, True)


@pytest.mark.parametrize("pause", [1.0, np.nan], ids=["later", "at no known time"])
def test_machine_that_went_away_and_came_back_has_jumped(pause):
    tracker = guided()
    names = [
        tracker.predict(rpm * RPM, pause * i).branch
        for i, rpm in enumerate([3900.0, INSIDE, 2.0 * INSIDE, INSIDE])
    ]
    assert names[1] == BranchName.UPPER
    assert tracker.predict(INSIDE * RPM, pause * 4).solution.eccentricity_max == pytest.approx(
        orbits(INSIDE)[0], abs=1e-8
    )


def test_wrong_speed_that_tells_no_branch_does_not_settle():
    tracker = guided()
    tracker.predict(INSIDE * RPM, 0.0)
    assert tracker.predict(0.5 * INSIDE * RPM, 0.02).solution.converged
    assert tracker.predict(LOWEST * RPM, 0.04).branch == BranchName.SINGLE
    tracker = guided()
    tracker.predict(INSIDE * RPM, 0.0)
    tracker.predict(0.5 * INSIDE * RPM, 0.02)
    assert tracker.predict(INSIDE * RPM, 0.04).branch == BranchName.UNKNOWN


@pytest.fixture
def clock(monkeypatch):
    """A processor that takes a millisecond for each evaluation, however busy the computer is."""
    ticks = count()
    clocks = SimpleNamespace(thread_time=lambda: 1e-3 * next(ticks), monotonic=lambda: 0.0)
    monkeypatch.setattr(time_limit, "time", clocks)


@pytest.fixture
def busy(monkeypatch):
    """A computer so busy that hardly any processor time comes while its clock goes on."""
    ticks = count()
    clocks = SimpleNamespace(thread_time=lambda: 0.0, monotonic=lambda: 5e-3 * next(ticks))
    monkeypatch.setattr(time_limit, "time", clocks)


def test_a_search_ends_on_a_busy_computer_too(busy):
    tracker = Tracker(balance(force=-1e-9), patience=0.1)
    followed(tracker, [3900.0, INSIDE])
    tracker.change(balance(force=-1e4))
    said = tracker.predict(INSIDE * RPM).solution.message
    assert said == "no solution was found within 0.25 s, as the computer is busy"


def test_patience_ends_a_search_which_a_new_curve_spares(clock):
    tracker = Tracker(balance(force=-1e-9), patience=0.1)
    followed(tracker, [3900.0, INSIDE])
    tracker.change(balance(force=-1e4))
    said = tracker.predict(INSIDE * RPM)
    assert said.solution.message == "no solution was found within 0.1 s of processor time"
    assert np.isnan(said.solution.coefficients).all()
    tracker.adopt(curve(force=-1e4))
    [found] = followed(tracker, [INSIDE])
    assert found.current
    expected = solve(balance(force=-1e4), INSIDE * RPM)
    difference = (found.solution.coefficients - expected.coefficients) / balance().clearances
    assert np.abs(difference).max() < 1e-9


ANY_SIZE = st.floats(-300.0, 300.0).map(lambda power: 10.0**power)
TOO_FEW_OR_MANY = st.floats(-9.0, 9.0).map(lambda power: 10.0**power)
WILD = st.one_of(ANY_SIZE, TOO_FEW_OR_MANY)
STRANGE = st.dictionaries(
    st.sampled_from(["unbalance", "force", "viscosity"]), st.floats(-9.0, 2.0), max_size=2
)


@pytest.mark.parametrize("with_curve", [True, False], ids=["curve", "no curve"])
@given(st.lists(st.tuples(WILD, STRANGE, st.booleans()), min_size=1, max_size=4))
@settings(max_examples=12, deadline=None, derandomize=True)
def test_wild_speeds_and_values_are_got_over(with_curve, wild):
    """After whatever was measured and set, a sane machine at a sane speed is found again."""
    tracker = Tracker(balance(), patience=0.4)
    if with_curve:
        tracker.adopt(curve())
    time = 0.0
    tracker.predict(3900.0 * RPM, time)
    for speed, changes, again in wild:
        values = {name: 10.0**power for name, power in changes.items()}
        tracker.change(balance.__wrapped__(**values))
        for _ in range(1 + again):
            time += 0.6  # too long for a speed that is back at once
            tracker.predict(speed, time)
    tracker.change(balance())
    said = [tracker.predict(3900.0 * RPM, time + 0.02 * i) for i in range(1, 6)]
    for one in said[2:]:
        assert one.solution.converged, one.solution.message
        assert one.solution.eccentricity_max == pytest.approx(orbits(3900.0)[0], abs=1e-8)
        assert one.branch == (BranchName.SINGLE if with_curve else BranchName.UNKNOWN)


@pytest.mark.parametrize("with_curve", [True, False], ids=["curve", "no curve"])
def test_speed_of_no_machine_is_left_at_once(with_curve):
    """At 1e6 rad/s nothing moves, so that no stride could be scaled by how far the last led."""
    tracker = guided() if with_curve else Tracker(balance())
    tracker.predict(3900.0 * RPM, 0.0)
    for i in range(10):
        tracker.predict(1e6, 0.2 + 0.1 * i)
    [after] = followed(tracker, [3900.0])
    assert after.solution.eccentricity_max == pytest.approx(orbits(3900.0)[0], abs=1e-8)


def test_searches_that_are_broken_off_again_and_again_begin_anew(clock):
    """Where the way from the last response is too long, it is given up, and the branch with it."""
    tracker = Tracker(balance(force=-1e-9), patience=0.1)
    tracker.adopt(curve(force=-1e-9))
    followed(tracker, [3900.0, INSIDE])
    assert tracker.settled
    tracker.change(balance(force=-1e4))
    said = [tracker.predict(INSIDE * RPM) for _ in range(3)]
    assert [one.solution.converged for one in said] == [False, False, True]
    assert said[2].branch == BranchName.UNKNOWN
    assert not tracker.settled
