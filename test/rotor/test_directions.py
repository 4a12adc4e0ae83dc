"""The sense of orbits, from shapes whose sense is known."""

import numpy as np
import pytest

from sfd_hbm_ros.rotor.directions import Direction, direction, senses


@pytest.mark.parametrize(
    ("x", "y", "sense", "name"),
    [
        (1.0, -1.0j, 1.0, Direction.FORWARD),  # (cos wt, sin wt)
        (1.0, 1.0j, -1.0, Direction.BACKWARD),
        (1.0, 2.0, 0.0, Direction.PLANAR),
        (2.0, -1.0j, 0.8, Direction.FORWARD),  # area 2 of an ellipse over the mean square 2.5
    ],
)
def test_sense_of_an_orbit(x, y, sense, name):
    # Turning a mode's phase and size changes nothing.
    shape = (0.3 - 0.4j) * np.array([[x], [y]])
    [found] = senses(3.0 * np.eye(2), shape)
    assert found == pytest.approx(sense, abs=1e-15)
    assert direction(found) == name


def test_opposite_orbits_weigh_by_the_mass_that_runs_them():
    forward_then_backward = np.array([[1.0], [-1.0j], [1.0], [1.0j]])
    [sense] = senses(np.diag([3.0, 3.0, 1.0, 1.0]), forward_then_backward)
    assert sense == pytest.approx(0.5, abs=1e-15)
