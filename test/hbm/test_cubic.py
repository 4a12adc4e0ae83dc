"""The cubic along which a branch is continued, on a circle as the branch."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm.cubic import cubic_through
from sfd_hbm_ros.hbm.points import Point

SCALE = np.array([2.0, 0.5])


def point(angle):
    """A point of a circle about the origin, of radius 1 in the scaled unknowns."""
    x, value = SCALE * (np.cos(angle), np.sin(angle))
    return Point(value, np.array([x]), np.array([-np.sin(angle), np.cos(angle)]), 0.0, 0)


@pytest.mark.parametrize("ahead", [-0.5, 0.5, 1.5], ids=["behind", "between", "beyond"])
def test_error_is_of_fourth_order(ahead):
    errors = []
    for step in (0.1, 0.05, 0.025):
        distance = ahead * np.sin(step)  # along the tangent at the angle 0
        found = cubic_through(point(0.0), point(step), SCALE)(distance)
        assert found[1] == pytest.approx(distance, abs=1e-15)
        errors.append(abs(found[0] - np.sqrt(1.0 - distance**2)))
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(4.0, abs=0.2)


def test_branch_that_turns_back_has_no_cubic():
    assert cubic_through(point(0.0), point(1.5), SCALE) is None


def test_single_point_has_no_cubic():
    assert cubic_through(point(0.3), point(0.3), SCALE) is None
