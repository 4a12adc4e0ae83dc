"""Curves take as many harmonics as they need, and say how far they are from all of them."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.accuracy import (
    balance_for_entry,
    balance_for_speeds,
    curve_error,
)
from sfd_hbm_ros.response.curves.curve import parameter_curve, response_curve

from ...hbm.machines import PAPER

RPM = np.pi / 30.0
GRAVITY = override_all(PAPER, {"gravity": True})
SOFT = override_all(GRAVITY, {"dampers.damper_1.centering_stiffness": 2.627e5})
STIFFNESS = "dampers.damper_1.centering_stiffness"


def fold_speeds(balance, *rpm):
    curve = response_curve(balance, *(value * RPM for value in rpm))
    [branch] = curve.branches
    return curve, branch.values[branch.fold] / RPM


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-7])
def test_folds_are_as_near_to_those_of_all_harmonics_as_the_estimate_says(tolerance):
    """At a fold the response at the speed itself has no estimate; the branch has one."""
    speeds = 3900.0 * RPM, 4000.0 * RPM
    balance = balance_for_speeds(GRAVITY, *speeds, HarmonicsOptions(tolerance, fewest=2))
    curve, folds = fold_speeds(balance, 3900.0, 4000.0)
    _, exact = fold_speeds(balance.with_harmonics(Harmonics(20)), 3900.0, 4000.0)
    assert len(folds) == len(exact) == 2
    error = curve_error(curve)
    assert error <= 2.0 * tolerance
    assert np.abs(folds / exact - 1.0).max() <= 2.0 * error


def test_a_machine_takes_more_harmonics_where_it_needs_them():
    easy = balance_for_speeds(GRAVITY, 3000.0 * RPM, 6000.0 * RPM)
    hard = balance_for_speeds(SOFT, 1500.0 * RPM, 3000.0 * RPM)
    assert easy.harmonics.highest == HarmonicsOptions().fewest
    assert hard.harmonics.highest > 2 * HarmonicsOptions().fewest
    curve = response_curve(hard, 1500.0 * RPM, 3000.0 * RPM)
    few = response_curve(hard.with_harmonics(Harmonics(7)), 1500.0 * RPM, 3000.0 * RPM)
    assert curve_error(curve) < 2e-5 < curve_error(few)


def test_a_number_that_was_asked_for_is_kept():
    options = HarmonicsOptions(fewest=3, most=3)
    balance = balance_for_speeds(SOFT, 1500.0 * RPM, 3000.0 * RPM, options)
    assert balance.harmonics == Harmonics(3)


def test_so_do_curves_over_an_entry():
    options = HarmonicsOptions(fewest=3)
    bounds = 2.627e5, 4.0e5
    balance = balance_for_entry(SOFT, 2000.0 * RPM, STIFFNESS, bounds, options)
    curve = parameter_curve(balance, 2000.0 * RPM, STIFFNESS, *bounds)
    assert 3 < balance.harmonics.highest < HarmonicsOptions().most
    assert curve_error(curve) < 1e-5
