"""Questions about other speeds, temperatures, and the other branch's eccentricities."""

import math

import numpy as np
import pytest

pytest.importorskip("rclpy")

from sensor_msgs.msg import Temperature

from sfd_hbm_ros.hbm import Harmonics, JournalMotion
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages.common import eccentricity_message, read_temperature
from sfd_hbm_ros.node.messages.what_if import (
    MOST,
    Answer,
    read_what_if,
    refusals,
    what_if_message,
)

from ..graph import JointState, Time

NAMES = ["max", "mean", "static_x", "static_y", "other_branch/max"]


def circle(eccentricity: float) -> dict[str, JournalMotion]:
    """A circular orbit about the centre."""
    coefficients = 1e-4 * eccentricity * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    return {"damper_1": JournalMotion("damper_1", 1e-4, Harmonics(1), coefficients)}


def test_answers_stand_in_the_order_of_the_questions():
    nothing = circle(math.nan)
    answers = [
        Answer(400.0, circle(0.8), circle(0.2)),
        Answer(100.0, circle(0.1), {}),
        Answer(300.0, nothing, nothing),
    ]
    message = what_if_message(Time(nanoseconds=7), "rotor", answers)
    assert message.header.stamp.nanosec == 7
    assert list(message.name) == [f"damper_1/{name}" for name in NAMES] * 3
    assert list(message.velocity) == [400.0] * 5 + [100.0] * 5 + [300.0] * 5
    nan = math.nan
    expected = [0.8, 0.8, 0.0, 0.0, 0.2, 0.1, 0.1, 0.0, 0.0, nan, nan, nan, nan, nan, nan]
    assert list(message.position) == pytest.approx(expected, abs=1e-12, nan_ok=True)


def test_the_other_branch_stands_beside():
    message = eccentricity_message(Time(), "rotor", circle(0.4), circle(0.9), 300.0)
    read = dict(zip(message.name, message.position, strict=True))
    assert read["damper_1/max"] == pytest.approx(0.4)
    assert read["damper_1/other_branch/max"] == pytest.approx(0.9)
    assert list(message.velocity) == [300.0] * len(message.name)


def test_a_refusal_says_why_beside_numbers_that_are_none():
    nothing = circle(math.nan)
    message = what_if_message(Time(), "rotor", refusals([400.0, 500.0], nothing, "no curve"))
    names = [f"damper_1/{name}" for name in NAMES]
    assert list(message.name) == [*names, "reason: no curve", *names]
    assert list(message.velocity) == [400.0] * 6 + [500.0] * 5
    assert np.isnan(message.position).all()
    message = what_if_message(Time(), "rotor", refusals([], {}, "no machine"))
    assert (list(message.name), len(message.velocity)) == (["reason: no machine"], 1)


def test_no_other_branch_is_not_a_number():
    message = eccentricity_message(Time(), "rotor", circle(0.4), {}, 300.0)
    assert message.name[-1] == "damper_1/other_branch/max"
    assert math.isnan(message.position[-1])


def test_speeds_are_read():
    assert read_what_if(JointState(velocity=[400.0, 1.0, 400.0])) == [400.0, 1.0, 400.0]


@pytest.mark.parametrize(
    ("speeds", "sentence"),
    [
        ([], rf"velocity must hold 1 to {MOST} rotor speeds \[rad/s\], not 0"),
        ([1.0] * (MOST + 1), rf"velocity must hold 1 to {MOST} .* not {MOST + 1}"),
        ([1.0, 0.0], r"velocity\[1\] must be a finite number \[rad/s\] above 0, not 0.0"),
        ([-1.0], r"velocity\[0\] must be .* not -1.0"),
        ([math.nan], r"velocity\[0\] must be .* not nan"),
        ([math.inf], r"velocity\[0\] must be .* not inf"),
    ],
)
def test_speeds_that_cannot_be_are_refused(speeds, sentence):
    with pytest.raises(InputError, match=sentence):
        read_what_if(JointState(velocity=speeds))


@pytest.mark.parametrize("celsius", [-273.15, 0.0, 45.5])
def test_a_temperature_is_read(celsius):
    assert read_temperature(Temperature(temperature=celsius)) == celsius


@pytest.mark.parametrize("celsius", [-274.0, math.nan, math.inf, -math.inf])
def test_a_temperature_that_cannot_be_is_refused(celsius):
    sentence = rf"temperature must be .* \[deg C\] of at least -273.15, not {celsius}"
    with pytest.raises(InputError, match=sentence):
        read_temperature(Temperature(temperature=celsius))
