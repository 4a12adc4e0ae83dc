"""Measured orbits: what is predicted can be read as measured, and nothing else can."""

import math

import numpy as np
import pytest

pytest.importorskip("rclpy")

from sfd_hbm_ros.hbm import Harmonics, JournalMotion
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages.common import harmonics_message
from sfd_hbm_ros.node.messages.measured import read_measured

from ..graph import JointState, Time


@pytest.mark.parametrize("harmonics", [Harmonics(3), Harmonics(2, revolutions=2)], ids=str)
def test_what_is_predicted_is_read_as_it_was(harmonics):
    rng = np.random.default_rng(5)
    motions = {
        name: JournalMotion(name, 1e-4, harmonics, 1e-5 * rng.normal(size=(harmonics.rows, 2)))
        for name in ("a", "b damper")
    }
    measured = read_measured(harmonics_message(Time(), "rotor", motions))
    angle = np.linspace(0.0, 6.0, 7)
    for name, motion in motions.items():
        for axis, expected in zip("xy", motion.at(angle).T, strict=True):
            terms = [
                measured[f"{name}/{axis}/{order:g}x/amplitude"]
                * np.cos(order * angle - measured[f"{name}/{axis}/{order:g}x/phase"])
                for order in harmonics.orders[1:]
            ]
            np.testing.assert_allclose(measured[f"{name}/{axis}/0x"] + sum(terms), expected)
    assert len(measured) == 2 * 2 * (2 * len(harmonics.orders) - 1)


def test_amplitudes_need_no_phase():
    names = ["d/x/0.5x/amplitude", "d/x/0.333333x/amplitude", "d/y/1x/amplitude"]
    read = read_measured(JointState(name=names, position=[1.0, 2.0, 0.0]))
    assert read == dict(zip(names, [1.0, 2.0, 0.0], strict=True))


@pytest.mark.parametrize(
    ("names", "values", "sentence"),
    [
        (["d/x/0x"], [], "position must hold a number for each of the 1 names, not 0"),
        (["d/x/0x", "d/x/0x"], [1.0, 1.0], "d/x/0x must be given once"),
        (["d/x/0x"], [math.nan], "d/x/0x must be a finite number, not nan"),
        (["d/x/1x/phase"], [math.inf], "d/x/1x/phase must be a finite number, not inf"),
        (["d/x/1x/amplitude"], [-1.0], "amplitude must be a finite number of at least 0, not -1"),
        (["d/x/1x/phase"], [1.0], "d/x/1x/phase must come with its amplitude"),
        (["d/z/0x"], [1.0], "'d/z/0x' must be the name of a harmonic"),
        (["d/x/1x"], [1.0], "'d/x/1x' must be the name of a harmonic"),
        (["d/x/0x/amplitude"], [1.0], "'d/x/0x/amplitude' must be the name of a harmonic"),
        (["d/x/0.0x/phase"], [1.0], "'d/x/0.0x/phase' must be the name of a harmonic"),
        (["d/x/-1x/phase"], [1.0], "'d/x/-1x/phase' must be the name of a harmonic"),
        (["d/x/1.0x/phase"], [1.0], "'d/x/1.0x/phase' must be the name of a harmonic"),
        (["d/x/01x/phase"], [1.0], "'d/x/01x/phase' must be the name of a harmonic"),
        (["/x/0x"], [1.0], "'/x/0x' must be the name of a harmonic"),
        (["x" * 5000 + "/x/0x"], [math.nan], "must be a finite number"),
        (["x" * 5000 + "/x/2x/phase"], [1.0], "must come with its amplitude"),
        (["d/x/nanx/phase"], [1.0], "'d/x/nanx/phase' must be the name of a harmonic"),
        (["x/" * 5000], [1.0], r"must be the name of a harmonic"),
        ([], [], "name must hold the names of measured harmonics, it is empty"),
        ([""], [1.0], "'' must be the name of a harmonic: DAMPER/x/0x"),
    ],
)
def test_what_cannot_be_read_is_refused(names, values, sentence):
    with pytest.raises(InputError, match=sentence) as refused:
        read_measured(JointState(name=names, position=values))
    assert len(str(refused.value)) < 200
