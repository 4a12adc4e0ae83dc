"""The estimate of what harmonics left out would add, against a solution of many more."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions, solve_accurately, truncation_error
from sfd_hbm_ros.machine import override_all

from .machines import PAPER

RPM = np.pi / 30.0
SOFT = {"gravity": True, "dampers.damper_1.centering_stiffness": 2.627e5}
GRAVITY = {"gravity": True}
REFERENCE = Harmonics(47)


def distance(machine, speed, solution):
    """Greatest distance from the solution of 47 harmonics, of the clearance."""
    balance = HarmonicBalance(machine, REFERENCE)
    reference = solve(balance, speed, solution)
    assert reference.converged
    known = REFERENCE.change_from(solution.harmonics, solution.coefficients)
    difference = (known - reference.coefficients).ravel()
    return balance.at(speed).eccentricity(difference)


@pytest.mark.parametrize("changes", [GRAVITY, SOFT], ids=["gravity", "soft spring"])
@pytest.mark.parametrize("rpm", [2000.0, 3900.0])
@pytest.mark.parametrize("highest", [3, 5, 7])
def test_the_estimate_is_the_error(changes, rpm, highest):
    """Within a factor of two, over errors from 1e-8 to 1e-3."""
    machine = override_all(PAPER, changes)
    balance = HarmonicBalance(machine, Harmonics(highest))
    solution = solve(balance, rpm * RPM)
    assert solution.converged
    error = distance(machine, rpm * RPM, solution)
    estimate = truncation_error(balance, solution)
    assert 0.5 * error < estimate < 2.0 * error + 1e-12


def test_a_circle_needs_no_more():
    balance = HarmonicBalance(PAPER, Harmonics(1))
    assert truncation_error(balance, solve(balance, 3900.0 * RPM)) < 1e-12


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_as_many_are_taken_as_the_tolerance_asks_for(tolerance):
    machine = override_all(PAPER, SOFT)
    options = HarmonicsOptions(tolerance=tolerance, fewest=3)
    found = solve_accurately(machine, 2000.0 * RPM, options)
    assert found.error <= tolerance
    assert distance(machine, 2000.0 * RPM, found.solution) <= 2.0 * tolerance
    fewer = Harmonics(found.solution.harmonics.highest * 2 // 3 - 1)
    balance = HarmonicBalance(machine, fewer)
    assert truncation_error(balance, solve(balance, 2000.0 * RPM)) > tolerance


def test_the_most_harmonics_are_taken_where_they_are_too_few():
    machine = override_all(PAPER, SOFT)
    found = solve_accurately(machine, 2000.0 * RPM, HarmonicsOptions(1e-12, 3, 8))
    assert found.solution.harmonics.highest == 8
    assert found.error > 1e-12


@pytest.mark.parametrize("wrong", [{"tolerance": 0.0}, {"fewest": 0}, {"fewest": 9, "most": 8}])
def test_options_out_of_range_are_refused(wrong):
    with pytest.raises(ValueError, match="not allowed"):
        HarmonicsOptions(**wrong)
