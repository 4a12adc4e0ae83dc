"""What a machine would do elsewhere, against closed-form orbits and the tracker's journeys."""

import numpy as np
import pytest

from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.tracking.what_if import NO_CURVE, OUTSIDE, what_if

from .test_tracker import HIGHEST, INSIDE, LOWEST, RPM, balance, followed, guided, orbits

ASKED = [LOWEST, 3950.0, INSIDE, 4050.0, HIGHEST]


@pytest.mark.parametrize("here", [3900.0, 4080.0], ids=["below the folds", "above them"])
def test_it_is_what_a_journey_would_show(here):
    tracker = guided()
    [before] = followed(tracker, [here])
    for rpm in ASKED:
        found = what_if(tracker.guide, tracker.place, rpm * RPM)
        traveller = guided()
        expected = followed(traveller, [here, rpm])[-1]
        assert (found.branch, found.jumped) == (expected.branch, expected.jumped)
        assert found.solution.coefficients == pytest.approx(
            expected.solution.coefficients, abs=1e-8 * 2.54e-4
        )
        assert (found.other is None) == (expected.other is None)
    [after] = followed(tracker, [here])
    assert not after.jumped
    np.testing.assert_allclose(
        after.solution.coefficients, before.solution.coefficients, atol=1e-15
    )


def test_both_stable_orbits_are_those_of_the_closed_form():
    tracker = guided()
    lower, _, upper = orbits(INSIDE)
    for here, own, other in ((3900.0, upper, lower), (4080.0, lower, upper)):
        followed(tracker, [here])
        found = what_if(tracker.guide, tracker.place, INSIDE * RPM)
        assert found.solution.eccentricity_max == pytest.approx(own, abs=1e-8)
        assert found.other.eccentricity_max == pytest.approx(other, abs=1e-8)


def test_without_a_place_the_machine_runs_up():
    tracker = guided()
    assert tracker.place is None
    found = what_if(tracker.guide, None, INSIDE * RPM)
    assert found.branch is BranchName.UPPER
    assert found.solution.eccentricity_max == pytest.approx(orbits(INSIDE)[-1], abs=1e-8)


def test_an_outdated_curve_leads_to_solutions_of_the_present_machine():
    tracker = guided()
    followed(tracker, [3900.0])
    changed = balance(unbalance=1.01 * 5.039e-4)
    tracker.change(changed)
    found = what_if(tracker.guide, tracker.place, 3920.0 * RPM)
    residual = changed.at(3920.0 * RPM).residual(found.solution.coefficients.ravel())
    assert np.abs(residual).max() < 1e-8
    assert not found.current


@pytest.mark.parametrize("rpm", [LOWEST - 1.0, HIGHEST + 1.0, 1e200])
def test_where_the_curve_does_not_lead_there_is_no_answer(rpm):
    tracker = guided()
    followed(tracker, [3900.0])
    found = what_if(tracker.guide, tracker.place, rpm * RPM)
    assert (found.solution.converged, found.solution.message) == (False, OUTSIDE)
    assert np.isnan(found.solution.coefficients).all()
    assert np.isnan(found.solution.eccentricity_max)
    assert found.other is None


def test_without_a_curve_there_is_no_answer():
    found = what_if(Tracker(balance()).guide, None, INSIDE * RPM)
    assert (found.solution.converged, found.solution.message) == (False, NO_CURVE)
