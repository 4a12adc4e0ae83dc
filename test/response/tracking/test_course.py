"""The course of a branch between its points, against Newton's method and a fold's closed form."""

from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.place import Place, places_at
from sfd_hbm_ros.response.tracking.course import Course

from ...hbm.machines import PAPER

RPM = np.pi / 30.0


@cache
def curve():
    changes = {"unbalance.disk_2.magnitude": 5.039e-4, "unbalance.disk_2.station": "disk_1"}
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(1))
    return response_curve(balance, 3850.0 * RPM, 4095.0 * RPM)


def test_course_passes_through_the_points():
    [branch] = curve().branches
    course, clearance = Course(branch), curve().balance.clearances[0]
    for index in range(len(branch.values) - 1):
        for point in (index, index + 1):
            place = Place(branch, index, float(branch.values[point]))
            known = branch.solutions[point].coefficients
            # two neighbouring arcs have the speed of a fold, but for the polynomial's own
            limit = 1e-4 if branch.fold[point] else 1e-9
            assert np.abs(course.coefficients(place) - known).max() < limit * clearance


def test_course_is_nearer_than_a_straight_line_by_far():
    """The truth is what Newton's method finds; beside the folds there are steep places, too."""
    course, balance = Course(curve().branches[0]), curve().balance
    errors = []
    for speed in np.linspace(3851.0, 4094.0, 200) * RPM:
        for place in places_at(curve().branches, speed):
            begin = course.coefficients(place)
            truth = newton(balance.at(speed), begin.ravel())
            assert truth.outcome.converged
            x = truth.x.reshape(begin.shape)
            errors.append([np.abs(y - x).max() for y in (begin, place.coefficients)])
    near, straight = np.array(errors).T / balance.clearances[0]
    assert near.max() < 1e-3
    assert np.median(near) < 0.05 * np.median(straight)


@pytest.mark.parametrize("rpm", [3870.0, 3998.0, 4080.0])
def test_start_ends_newtons_method_within_two_steps(rpm):
    balance = curve().balance
    for place in places_at(curve().branches, rpm * RPM):
        begin = Course(place.branch).coefficients(place)
        found = newton(balance.at(rpm * RPM), begin.ravel())
        assert len(found.residuals) <= 3
