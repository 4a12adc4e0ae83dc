"""The acceleration from stamped speeds: exact ramps, noise, wrong speeds, stamps as they come."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import siegelslopes

from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator

RPM = np.pi / 30.0
SECOND = 1_000_000_000
START = 1_700_000_000 * SECOND  # stamps are times since 1970
WINDOW = 4.0
BIN = WINDOW / 32
RATE = 50.0

ANY_SIZE = st.floats(-1e100, 1e100)
patiently = settings(deadline=None)  # an example is hundreds of speeds


def estimates(times, speeds, **choices):
    """The acceleration after each of the samples [s], [rad/s]."""
    estimator = AccelerationEstimator(**choices)
    found = []
    for time, speed in zip(times, speeds, strict=True):
        estimator.add(START + round(time * SECOND), speed)
        found.append(estimator.acceleration)
    return np.array(found)


def regular(duration=20.0, rate=RATE):
    return np.arange(0.0, duration, 1.0 / rate)


def noisy_ramp(acceleration, seed, duration=20.0, noise=0.05):
    times = regular(duration)
    errors = np.random.default_rng(seed).normal(0.0, noise, len(times))
    return times, 400.0 + acceleration * times + errors


@patiently
@given(
    acceleration=st.floats(-50.0, 50.0).filter(lambda a: abs(a) > 0.05),
    steps=st.lists(st.floats(0.05, 3.9), min_size=30, max_size=150),
)
def test_a_ramp_is_found_exactly_at_any_stamps(acceleration, steps):
    times = np.cumsum(steps)
    found = estimates(times, 400.0 + acceleration * times)
    known = np.isfinite(found)
    assert known[-1]
    # a stamp is rounded to 0.5 ns, against bins of 0.1 s; means of speeds round to 1e-13 of them
    assert found[known] == pytest.approx(acceleration, rel=1e-6)


@patiently
@given(
    speeds=st.lists(st.floats(-10.0, 10.0), min_size=5, max_size=60),
    step=st.floats(0.13, 1.0),
)
def test_it_is_the_repeated_median(speeds, step):
    """By SciPy's own, for speeds that are too far apart to share a bin."""
    times = step * np.arange(len(speeds))
    [*_, found] = estimates(times, speeds, resolution=0.0)
    counted = (times >= times[-1] - WINDOW) | (np.arange(len(times)) >= len(times) - 8)
    expected = siegelslopes(np.array(speeds)[counted], times[counted])[0]
    if times[-1] >= 1.0:
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)


@patiently
@given(
    acceleration=st.floats(-20.0, 20.0).filter(lambda a: abs(a) > 0.05),
    wrong=st.dictionaries(st.integers(0, 400), ANY_SIZE, max_size=3),
)
def test_three_wrong_speeds_of_any_size_leave_no_trace(acceleration, wrong):
    """Not even in the first second, in a burst or apart."""
    times = regular(10.0)
    speeds = 400.0 + acceleration * times
    speeds[list(wrong)] = list(wrong.values())
    found = estimates(times, speeds)
    assert np.isfinite(found[times > 1.0 + BIN + 0.02]).all()
    assert found[np.isfinite(found)] == pytest.approx(acceleration, rel=1e-6)


@patiently
@given(wrong=st.dictionaries(st.integers(0, 40), ANY_SIZE, max_size=3))
def test_nor_do_they_where_speeds_are_rare(wrong):
    times = np.arange(0.0, 50.0, 1.0)
    speeds = 400.0 + times
    speeds[list(wrong)] = list(wrong.values())
    assert estimates(times, speeds)[7:] == pytest.approx(1.0)


@patiently
@given(at=st.integers(0, 300), shift=st.floats(0.001, 0.019))
def test_a_wrong_stamp_leaves_no_trace(at, shift):
    """One that keeps the order; others begin the estimate anew."""
    times = regular(10.0)
    speeds = 400.0 + 5.0 * times
    times[at] += shift
    found = estimates(times, speeds)
    assert found[np.isfinite(found)] == pytest.approx(5.0, rel=1e-6)


@patiently
@given(errors=st.lists(st.floats(-1.0, 1.0), min_size=41, max_size=41))
def test_bounded_errors_do_bounded_harm(errors):
    """At most 2 e over the distance that half of the others have from each point.

    Of n equally spaced points that is a quarter of their span, or (n - 1) // 4 of the spaces.
    """
    times = BIN * np.arange(41) * (1.0 + 1e-6)  # so that each is a bin
    [*_, found] = estimates(times, 400.0 + 3.0 * times + 0.2 * np.array(errors))
    bound = 2.0 * 0.2 / (BIN * ((32 - 1) // 4))
    assert abs(found - 3.0) <= bound


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_sign_of_a_slow_ramp_settles_in_noise(sign, seed):
    """1 rpm/s with 0.05 rad/s of noise at 50 Hz: right within 2 s, and for good."""
    times, speeds = noisy_ramp(sign * RPM, seed)
    found = estimates(times, speeds)
    assert (np.sign(found[times >= 2.0]) == sign).all()


@pytest.mark.parametrize("acceleration", [0.0, 3.0])
def test_error_left_by_noise_is_near_the_least_possible(acceleration):
    """That is of least squares, by Cramer and Rao: nothing unbiased does better."""
    times, speeds = noisy_ramp(acceleration, seed=1, duration=1000.0)
    errors = estimates(times, speeds, resolution=0.0)[times > WINDOW] - acceleration
    least = 0.05 * np.sqrt(12.0 / RATE / WINDOW**3)
    assert 0.95 * least < np.std(errors) < 1.25 * least
    # 250 windows that share nothing: the mean is off by their part of the deviation
    assert abs(np.mean(errors)) < 4.0 * np.std(errors) / np.sqrt(250.0)


def test_a_steady_speed_in_noise_is_steady():
    times, speeds = noisy_ramp(0.0, seed=2, duration=200.0)
    found = estimates(times, speeds)
    assert (found[times >= WINDOW] == 0.0).all()


def test_direction_does_not_flicker_at_the_resolution():
    """A ramp just at the resolution, about which its estimate goes to and fro."""
    times, speeds = noisy_ramp(0.02, seed=3, duration=200.0, noise=0.01)
    raw = estimates(times, speeds, resolution=0.0)[times >= 2.0] < 0.02
    steady = estimates(times, speeds)[times >= 2.0] == 0.0
    assert np.count_nonzero(np.diff(raw)) > 20
    assert np.count_nonzero(np.diff(steady)) <= 1


@patiently
@given(before=st.floats(-10.0, 10.0), after=st.floats(-10.0, 10.0))
def test_another_acceleration_is_taken_over_after_half_of_the_window(before, after):
    """Up to three bins sooner or later, and without going beyond either."""
    times = regular(15.0)
    speeds = 400.0 + before * times + (after - before) * np.maximum(times - 8.0, 0.0)
    found = estimates(times, speeds, resolution=0.0)
    early, late = 10.0 - 3.0 * BIN, 10.0 + 3.0 * BIN
    assert found[(times > 1.15) & (times < early)] == pytest.approx(before, abs=1e-6)
    assert found[times > late] == pytest.approx(after, abs=1e-6)
    between = found[(times >= early) & (times <= late)]
    assert (between >= min(before, after) - 1e-6).all()
    assert (between <= max(before, after) + 1e-6).all()


@patiently
@given(step=st.floats(-500.0, 500.0))
def test_a_step_of_the_speed_is_none_of_the_acceleration(step):
    """But for the moment at which half of the window lies on each side of it."""
    times = regular(15.0)
    speeds = 700.0 + 2.0 * times + step * (times >= 8.0)
    found = estimates(times, speeds)
    aside = (times > 1.15) & (np.abs(times - 10.0) > 3.0 * BIN)
    assert found[aside] == pytest.approx(2.0, abs=1e-6)


@patiently
@given(lost=st.sets(st.integers(150, 450), max_size=200))
def test_what_is_lost_is_not_missed(lost):
    times = regular(12.0)
    kept = np.array([i for i in range(len(times)) if i not in lost])
    found = estimates(times[kept], 400.0 - 3.0 * times[kept])
    assert found[times[kept] > 1.15] == pytest.approx(-3.0, rel=1e-6)


def test_unknown_until_there_is_enough():
    times = np.arange(0.0, 3.0, 0.02)
    found = estimates(times, 400.0 + times)
    assert np.isnan(found[times < 0.99]).all()
    assert np.isfinite(found[times > 1.01 + BIN]).all()
    assert np.isnan(estimates([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 3.0, 4.0])).all()


def test_a_repeated_stamp_changes_nothing():
    estimator = AccelerationEstimator()
    for i in range(100):
        estimator.add(START + i * SECOND // 50, 400.0 + 0.02 * i)
    before = estimator.acceleration
    estimator.add(START + 99 * SECOND // 50, 1000.0)
    assert estimator.acceleration == before == pytest.approx(1.0)


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf])
def test_a_speed_that_is_no_number_changes_nothing(speed):
    times = np.arange(0.0, 3.0, 0.1)
    speeds = 400.0 + times
    found = estimates(np.append(times, 3.0), np.append(speeds, speed))
    assert found[-1] == found[-2] == pytest.approx(1.0)


@pytest.mark.parametrize("gap", [4.5, 3600.0, -0.5, -2.0, -3600.0])
def test_after_a_gap_or_a_clock_set_back_it_begins_anew(gap):
    times = np.arange(0.0, 3.0, 0.1)
    later = times + 2.9 + gap
    found = estimates(
        np.append(times, later), np.append(400.0 + times, 500.0 - 2.0 * (later - later[0]))
    )
    before, after = np.split(found, 2)
    assert before[-1] == pytest.approx(1.0)
    assert np.isnan(after[later < later[0] + 0.99]).all()
    assert after[later > later[0] + 1.01 + BIN] == pytest.approx(-2.0)


@pytest.mark.parametrize(
    ("refused", "sentence"),
    [
        ({"window": 0.0}, "window: 0.0 s is not allowed, it must be positive"),
        ({"window": math.nan}, "window: nan s is not allowed"),
        ({"resolution": -1.0}, "resolution: -1.0 rad/s2 is not allowed, it must be finite and"),
        ({"resolution": math.inf}, "resolution: inf rad/s2 is not allowed"),
    ],
)
def test_bad_settings_are_refused(refused, sentence):
    with pytest.raises(ValueError, match=sentence):
        AccelerationEstimator(**refused)


def test_speeds_beyond_what_numbers_can_hold_make_it_unknown():
    estimator = AccelerationEstimator()
    for i in range(200):
        estimator.add(round(i * 0.05 * SECOND), 1e308 * (i % 2))
    assert not math.isinf(estimator.acceleration)
    for i in range(200, 400):
        estimator.add(round(i * 0.05 * SECOND), 400.0 + 0.1 * i)
    assert estimator.acceleration == pytest.approx(2.0)


@pytest.mark.parametrize("noise", [0.0, 0.05])
@pytest.mark.parametrize("change", ["start", "reversal"])
def test_it_has_settled_only_where_it_tells_a_time(change, noise):
    """A tenth of a second after a start or a reversal as after seconds of it."""
    times = regular(30.0)
    errors = np.random.default_rng(3).normal(0.0, noise, len(times))
    before = 0.0 if change == "start" else 26.0
    speeds = 400.0 + np.where(times < 15.0, before * times, before * 15.0 - 26.0 * (times - 15.0))
    estimator = AccelerationEstimator()
    settled, found = [], []
    for time, speed in zip(times, speeds + errors, strict=True):
        estimator.add(START + round(time * SECOND), speed)
        settled.append(estimator.settled)
        found.append(estimator.acceleration)
    true = np.where(times < 15.0, before, -26.0)
    told = np.array(settled) & (np.array(found) != 0.0)
    late = times > 15.0 + WINDOW
    assert told[late].all()
    # what was so far is told for as long as another one has not been seen
    wrong = told & (times > 15.0 + 0.6 * WINDOW)
    assert np.array(found)[wrong] == pytest.approx(true[wrong], rel=0.3)
    between = told & (times > 15.0) & (times <= 15.0 + 0.6 * WINDOW)
    near = (abs(np.array(found) - true) < 8.0) | (abs(np.array(found) - before) < 8.0)
    assert near[between].all()
