"""The acceleration from stamped speeds: exact ramps, noise, and stamps as they really come."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator

RPM = np.pi / 30.0
SECOND = 1_000_000_000
START = 1_700_000_000 * SECOND  # stamps are times since 1970


def estimates(times, speeds, **settings):
    """The acceleration after each of the samples [s], [rad/s]."""
    estimator = AccelerationEstimator(**settings)
    found = []
    for time, speed in zip(times, speeds, strict=True):
        estimator.add(START + round(time * SECOND), speed)
        found.append(estimator.acceleration)
    return np.array(found)


def noisy_ramp(acceleration, seed, duration=20.0, noise=0.05, rate=50.0):
    times = np.arange(0.0, duration, 1.0 / rate)
    errors = np.random.default_rng(seed).normal(0.0, noise, len(times))
    return times, 400.0 + acceleration * times + errors


@given(
    acceleration=st.floats(-50.0, 50.0).filter(lambda a: abs(a) > 0.05),
    steps=st.lists(st.floats(0.05, 0.5), min_size=30, max_size=60),
)
def test_a_ramp_is_found_exactly_at_any_stamps(acceleration, steps):
    times = np.cumsum(steps)
    found = estimates(times, 400.0 + acceleration * times)
    known = np.isfinite(found)
    assert known[-1]
    # a stamp is rounded to 0.5 ns, against steps of 0.05 s; sums of speeds round to 1e-13 of them
    assert found[known] == pytest.approx(acceleration, rel=1e-6)


def test_it_is_the_weighted_least_squares_line():
    """By numpy's own fit to the whole history."""
    rng = np.random.default_rng(5)
    times = np.cumsum(rng.uniform(0.01, 0.3, 80))
    speeds = 300.0 + 5.0 * np.sin(times) + rng.normal(0.0, 0.1, 80)
    [*_, found] = estimates(times, speeds, time_constant=0.7, resolution=0.0)
    weights = np.exp(-0.5 * (times[-1] - times) / 0.7)  # polyfit squares them
    expected = np.polyfit(times - times[-1], speeds, 1, w=weights)[0]
    assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_sign_of_a_slow_ramp_settles_in_noise(sign, seed):
    """1 rpm/s with 0.05 rad/s of noise at 50 Hz: right within 2 s, and for good."""
    times, speeds = noisy_ramp(sign * RPM, seed)
    found = estimates(times, speeds)
    assert (np.sign(found[times >= 2.0]) == sign).all()


def test_error_left_by_noise_is_that_of_the_theory():
    times, speeds = noisy_ramp(0.0, seed=1, duration=1000.0)
    found = estimates(times, speeds, resolution=0.0)[500:]
    expected = 0.05 * np.sqrt(0.02 / 4.0)
    assert np.std(found) == pytest.approx(expected, rel=0.1)
    assert abs(np.mean(found)) < 0.1 * expected


def test_a_steady_speed_in_noise_is_steady():
    times, speeds = noisy_ramp(0.0, seed=2, duration=200.0)
    found = estimates(times, speeds)
    assert (found[times >= 2.0] == 0.0).all()


def test_direction_does_not_flicker_at_the_resolution():
    """A ramp just at the resolution, about which its estimate goes to and fro."""
    times, speeds = noisy_ramp(0.02, seed=3, duration=200.0, noise=0.01)
    raw = estimates(times, speeds, resolution=0.0)[times >= 2.0] < 0.02
    steady = estimates(times, speeds)[times >= 2.0] == 0.0
    assert np.count_nonzero(np.diff(raw)) > 20
    assert np.count_nonzero(np.diff(steady)) <= 1


def test_a_change_of_the_acceleration_is_followed():
    """By 90 % after four time constants: 1 - (1 + u) exp(-u) of it after u of them."""
    times = np.arange(0.0, 30.0, 0.02)
    speeds = 400.0 + 2.0 * np.maximum(times - 20.0, 0.0)
    found = estimates(times, speeds)
    for u in (1.0, 2.0, 4.0):
        [after] = found[np.isclose(times, 20.0 + u)]
        assert after == pytest.approx(2.0 * (1.0 - (1.0 + u) * np.exp(-u)), abs=0.03)


def test_unknown_until_there_is_enough():
    times = np.arange(0.0, 3.0, 0.02)
    found = estimates(times, 400.0 + times)
    assert np.isnan(found[times < 0.99]).all()
    assert np.isfinite(found[times > 1.01]).all()
    assert np.isnan(estimates([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 3.0, 4.0])).all()


@pytest.mark.parametrize("late", [0.0, -0.5])
def test_repeated_and_late_stamps_change_nothing(late):
    estimator = AccelerationEstimator()
    for i in range(100):
        estimator.add(START + i * SECOND // 50, 400.0 + 0.02 * i)
    before = estimator.acceleration
    estimator.add(START + 99 * SECOND // 50 + round(late * SECOND), 1000.0)
    assert estimator.acceleration == before == pytest.approx(1.0)


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf])
def test_a_speed_that_is_no_number_changes_nothing(speed):
    times = np.arange(0.0, 3.0, 0.1)
    speeds = 400.0 + times
    found = estimates(np.append(times, 3.0), np.append(speeds, speed))
    assert found[-1] == found[-2] == pytest.approx(1.0)


@pytest.mark.parametrize("gap", [3.5, 3600.0, -3600.0])
def test_after_a_gap_or_a_clock_set_back_it_begins_anew(gap):
    times = np.arange(0.0, 3.0, 0.1)
    later = times + 2.9 + gap
    found = estimates(
        np.append(times, later), np.append(400.0 + times, 500.0 - 2.0 * (later - later[0]))
    )
    before, after = np.split(found, 2)
    assert before[-1] == pytest.approx(1.0)
    assert np.isnan(after[later < later[0] + 0.99]).all()
    assert after[later > later[0] + 1.01] == pytest.approx(-2.0)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"time_constant": 0.0}, "time_constant: 0.0 s is not allowed, it must be positive"),
        ({"time_constant": math.nan}, "time_constant: nan s is not allowed"),
        ({"resolution": -1.0}, "resolution: -1.0 rad/s2 is not allowed, it must be finite and"),
        ({"resolution": math.inf}, "resolution: inf rad/s2 is not allowed"),
    ],
)
def test_bad_settings_are_refused(settings, sentence):
    with pytest.raises(ValueError, match=sentence):
        AccelerationEstimator(**settings)
