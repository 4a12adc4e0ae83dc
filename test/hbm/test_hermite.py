"""The polynomial along which a branch is continued, on a circle as the branch."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm.hermite import along_branch
from sfd_hbm_ros.hbm.points import Point

SCALE = np.array([2.0, 0.5])


def point(angle):
    """A point of a circle about the origin, of radius 1 in the scaled unknowns."""
    x, value = SCALE * (np.cos(angle), np.sin(angle))
    return Point(value, np.array([x]), np.array([-np.sin(angle), np.cos(angle)]), 0.0, 0)


def error(angles, distance):
    """Distance from the circle of the polynomial through points at angles, the first 0."""
    found = along_branch([point(angle) for angle in angles], SCALE)(distance)
    assert found[1] == pytest.approx(distance, abs=1e-15)
    return abs(found[0] - np.sqrt(1.0 - distance**2))


@pytest.mark.parametrize("ahead", [-0.5, 0.5, 1.5], ids=["behind", "between", "beyond"])
@pytest.mark.parametrize("points", [1, 2, 3])
def test_order_of_the_error_is_twice_the_number_of_points(points, ahead):
    steps = np.array([0.1, 0.05, 0.025])
    errors = [error(step * np.arange(points), ahead * np.sin(step)) for step in steps]
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(2.0 * points, abs=0.25)


def test_points_after_the_branch_turned_back_are_not_used():
    assert error([0.0, 1.5], 0.1) == error([0.0], 0.1)


def test_point_given_twice_is_used_once():
    assert error([0.0, 0.0, 0.1], 0.1) == error([0.0], 0.1)


def test_point_off_the_branch_is_left_out():
    """What it adds is no correction of what the nearer ones say."""
    astray = point(-0.2)
    astray = Point(astray.value, astray.x + 0.1, astray.tangent, 0.0, 0)
    through = along_branch([point(0.0), point(-0.1), astray], SCALE)
    assert through(0.1) == pytest.approx(along_branch([point(0.0), point(-0.1)], SCALE)(0.1))
