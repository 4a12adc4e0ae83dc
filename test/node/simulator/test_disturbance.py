"""Noise, losses and wrong stamps: their sizes and shares, and none where none are asked for."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Harmonics, JournalMotion
from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.node.simulator.disturbance import Disturbance, DisturbanceSettings

MOTION = JournalMotion("a", 1e-4, Harmonics(7), np.full((15, 2), 1e-5))
STAMP = 10**18  # ns
NUMBER = 10_000
SPREAD = 5.0 / np.sqrt(NUMBER)  # five standard deviations of a mean, of the single one's


def disturbance(**settings: float) -> Disturbance:
    return Disturbance(DisturbanceSettings(seed=3, **settings))


def test_nothing_is_disturbed_unless_it_is_asked_for() -> None:
    none = disturbance()
    assert [none.speed(400.0), none.stamp(STAMP), none.loses()] == [400.0, STAMP, False]
    measured = none.journals({"a": MOTION})
    assert measured["a"].coefficients.tolist() == MOTION.coefficients.tolist()


def test_noise_of_the_speed_has_the_deviation_asked_for() -> None:
    noisy = disturbance(speed_noise=0.5)
    speeds = np.array([noisy.speed(400.0) for _ in range(NUMBER)])
    assert speeds.mean() == pytest.approx(400.0, abs=0.5 * SPREAD)
    assert speeds.std() == pytest.approx(0.5, rel=SPREAD)


def test_wrong_speeds_are_half_and_twice_the_right_one_alike() -> None:
    wrong = disturbance(wrong_speed=0.3)
    speeds = np.array([wrong.speed(400.0) for _ in range(NUMBER)])
    assert set(speeds) == {200.0, 400.0, 800.0}
    for speed in (200.0, 800.0):
        share = np.mean(speeds == speed)
        assert share == pytest.approx(0.15, abs=0.36 * SPREAD)  # sqrt(0.15 0.85) = 0.36


def test_a_measured_speed_is_not_negative() -> None:
    noisy = disturbance(speed_noise=0.5)
    assert min(noisy.speed(0.1) for _ in range(100)) == 0.0


def test_noise_of_the_orbit_has_the_deviation_asked_for() -> None:
    noisy = disturbance(orbit_noise=1e-6)
    noise = np.array(
        [noisy.journals({"a": MOTION})["a"].coefficients - 1e-5 for _ in range(NUMBER // 30)]
    )
    assert noise.mean() == pytest.approx(0.0, abs=1e-6 * SPREAD)
    assert noise.std() == pytest.approx(1e-6, rel=SPREAD)


def test_as_many_messages_are_lost_as_asked_for() -> None:
    lossy = disturbance(dropout=0.2)
    lost = np.mean([lossy.loses() for _ in range(NUMBER)])
    assert lost == pytest.approx(0.2, abs=0.4 * SPREAD)  # sqrt(0.2 0.8) = 0.4


def test_wrong_stamps_are_zero_past_and_future_alike() -> None:
    wrong = disturbance(wrong_stamp=0.3)
    stamps = np.array([wrong.stamp(STAMP) for _ in range(NUMBER)])
    kinds = stamps == 0, (stamps > 0) & (stamps < STAMP), stamps > STAMP
    for kind in kinds:
        assert kind.mean() == pytest.approx(0.1, abs=0.3 * SPREAD)  # sqrt(0.1 0.9) = 0.3
    off = np.abs(stamps[(stamps > 0) & (stamps != STAMP)] - STAMP) * 1e-9
    assert off.min() >= 1.0
    assert off.max() <= 3600.0


def test_the_same_seed_disturbs_the_same_way() -> None:
    first, second = disturbance(speed_noise=1.0), disturbance(speed_noise=1.0)
    assert [first.speed(9.0) for _ in range(5)] == [second.speed(9.0) for _ in range(5)]


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("dropout", 1.0, "dropout must be a finite number of at least 0 and below 1, not 1.0"),
        ("wrong_stamp", -0.1, "wrong_stamp must be a finite number of at least 0 and below 1"),
        ("orbit_noise", float("nan"), r"orbit_noise must be a finite number \[m\] of at least 0"),
        ("speed_noise", "much", r"speed_noise must be a finite number \[rad/s\] of at least 0"),
    ],
)
def test_a_bad_value_is_refused(key: str, value: object, sentence: str) -> None:
    with pytest.raises(MachineError, match=sentence):
        DisturbanceSettings(**{key: value})  # type: ignore[arg-type]
