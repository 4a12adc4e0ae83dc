"""The quasi-periodic branch as a part of the response curve: the paper's rotor at 503.9 g mm.

The quasi-periodic responses themselves are judged in `test_quasi_periodic` and in time in
`test_quasi_periodic_in_time`; here is what the curve, its jumps and the tracker make of them.
"""

import pickle

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Instability, Solution
from sfd_hbm_ros.hbm.quasi_periodic_response import QuasiPeriodicResponse
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.place import places_at, solutions_at
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.responses import distance
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.warning.jump_map import jump_map

from ...hbm.test_circular_orbit import circular_orbits
from ...hbm.test_quasi_periodic import neimark_sacker, uncondensed_imbalance
from .test_curve import RPM, paper_curve


def curve():
    return paper_curve("disk_2", 5.039e-4)


def upper_circle(rpm):
    """Eccentricity of the upper circle, by the closed form."""
    found = circular_orbits(curve().balance.machine, curve().balance.model, rpm * RPM)
    return found[-1][0]


def test_branch_leaves_where_the_circle_loses_stability():
    circles, _, leaving = curve().branches
    (point, kind), (again, _) = circles.onsets
    assert circles.worst_eccentricity[again] > 0.995  # next to the wall it is stable again
    assert kind is Instability.NEIMARK_SACKER
    assert circles.values[point] == pytest.approx(neimark_sacker(), abs=0.05 * RPM)
    assert curve().meeting(leaving, 0) == [(circles, point)]
    assert (circles.periodic, leaving.periodic) == (True, False)
    assert distance(leaving.solutions[0], circles.solutions[point]) < 1e-12
    assert leaving.worst_eccentricity[0] == pytest.approx(circles.worst_eccentricity[point])
    assert leaving.stable.all()
    assert np.all(np.diff(leaving.worst_eccentricity) > 0.0)


def test_response_between_two_points_is_in_balance():
    leaving = curve().branches[2]
    [(_, response)] = solutions_at(leaving, 4145.0 * RPM)
    assert isinstance(response, QuasiPeriodicResponse)
    assert response.speed == 4145.0 * RPM
    assert uncondensed_imbalance(curve().balance, response) < 1e-9


def test_run_up_jumps_where_the_branch_closes():
    """From there it lands on the lower circle; the coast-down meets circles only."""
    leaving = curve().branches[2]
    [up], [down] = (jumps(curve(), direction) for direction in Direction)
    assert up.value == leaving.values[-1]
    assert 4159.0 * RPM < up.value < 4161.0 * RPM
    assert up.before is leaving.solutions[-1]
    machine, model = curve().balance.machine, curve().balance.model
    landing = circular_orbits(machine, model, up.value)[0][0]
    assert up.after.eccentricity_max == pytest.approx(landing, abs=1e-7)
    assert isinstance(down.before, Solution)
    assert isinstance(down.after, Solution)
    assert Summary(curve()).hysteresis == pytest.approx(up.value - down.value)


def test_tracker_says_that_it_moves_about_an_unstable_circle():
    """Its solution is the circle, its place the quasi-periodic one, and it jumps at its end."""
    tracker, ahead = Tracker(curve().balance), jump_map(curve())
    tracker.adopt(curve())
    leaving = curve().branches[2]
    last = leaving.values[-1]
    for rpm in (3600.0, 4120.0, 4140.0, 4155.0, 4140.0, 4120.0, 4150.0):
        said = tracker.predict(rpm * RPM)
        about = rpm * RPM > leaving.values[0]
        assert (said.solution.converged, said.jumped, said.stable) == (True, False, not about)
        assert (said.place.branch is leaving) == about
        assert said.solution.eccentricity_max == pytest.approx(upper_circle(rpm), abs=1e-7)
        assert ahead.outlook(said.place, 1.0).run_up.speed == last
    assert said.place.eccentricity > said.solution.eccentricity_max + 0.01
    assert said.branch is BranchName.UPPER
    jumped = tracker.predict(last + 0.1 * RPM)
    assert (jumped.jumped, jumped.stable, jumped.branch) == (True, True, BranchName.SINGLE)


def test_tracker_that_settles_on_the_unstable_circle_is_quasi_periodic():
    tracker, (circles, lower, leaving) = Tracker(curve().balance), curve().branches
    tracker.adopt(curve())
    [(_, circle)] = solutions_at(circles, 4150.0 * RPM)
    tracker.settle(circle)
    said = tracker.predict(4150.0 * RPM)
    assert said.place.branch is leaving
    tracker.settle(said.other)
    said = tracker.predict(4150.0 * RPM)
    assert said.place.branch is lower
    assert said.other.eccentricity_max == pytest.approx(upper_circle(4150.0), abs=1e-7)


def test_curve_survives_pickling():
    """As it does on the way from the worker process."""
    sent = pickle.loads(pickle.dumps(curve()))
    [up] = jumps(sent, Direction.RUN_UP)
    [expected] = jumps(curve(), Direction.RUN_UP)
    assert up.value == expected.value
    assert distance(up.before, expected.before) == 0.0
    [place] = places_at([sent.branches[2]], 4145.0 * RPM)
    assert place.stable
