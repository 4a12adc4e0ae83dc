"""Selected harmonics against the solution of the whole trial group."""

import itertools

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.selected_branch import SelectedBranch
from sfd_hbm_ros.hbm.selection import SelectedBalance
from sfd_hbm_ros.machine import override_all

from .machines import PAPER

RPM = np.pi / 30.0
SOFT = {"gravity": True, "dampers.damper_1.centering_stiffness": 2.627e5}


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
@pytest.mark.parametrize("changes", [{"gravity": True}, SOFT], ids=["stiff", "soft"])
def test_branch_lies_within_the_tolerance_of_the_full_one(changes, tolerance):
    balance = SelectedBalance(override_all(PAPER, changes), Harmonics(9), tolerance)
    points = list(SelectedBranch(balance, 2000 * RPM, 6000 * RPM).selected())
    assert points[-1].point.value == 6000 * RPM
    assert max(len(at.group) for at in points) > 2
    for at in points[::5]:
        assert at.neglect.error <= tolerance
        equations = balance.full.at(at.point.value)
        embedded = balance.embed(at.group, at.point.x)
        full = newton(equations, embedded)
        assert full.outcome.converged
        assert equations.eccentricity(full.x - embedded) <= at.neglect.error + 1e-9


def test_a_tolerance_that_rounding_exceeds_takes_the_whole_group():
    """What the trial group itself finds is what it is compared to."""
    balance = SelectedBalance(override_all(PAPER, {"gravity": True}), Harmonics(3), 1e-13)
    branch = SelectedBranch(balance, 3000 * RPM, 3002 * RPM)
    points = list(branch.selected())
    assert branch.stop is Stop.RANGE
    assert points[-1].point.value == 3002 * RPM
    assert {at.group for at in points} == {(0, 1, 2, 3)}


def test_group_grows_with_the_tolerance_and_does_not_flicker():
    machine = override_all(PAPER, SOFT)
    groups = {}
    for tolerance in (1e-2, 1e-4):
        balance = SelectedBalance(machine, Harmonics(9), tolerance)
        points = list(SelectedBranch(balance, 2000 * RPM, 6000 * RPM).selected())
        groups[tolerance] = [at.group for at in points]
        changes = sum(a.group != b.group for a, b in itertools.pairwise(points))
        assert changes <= 8
    assert np.mean([len(g) for g in groups[1e-2]]) < np.mean([len(g) for g in groups[1e-4]])


def test_circular_orbit_needs_the_order_of_the_speed_alone():
    branch = SelectedBranch(SelectedBalance(PAPER, Harmonics(7)), 3900 * RPM, 4000 * RPM)
    assert {at.group for at in branch.selected()} == {(0, 1)}


@pytest.mark.parametrize("revolutions", [2, 3])
def test_sub_harmonics_of_a_synchronous_response_are_none(revolutions):
    machine = override_all(PAPER, SOFT)
    plain = solve(HarmonicBalance(machine, Harmonics(5)), 3000 * RPM)
    longer = Harmonics(5, revolutions=revolutions)
    solution = solve(HarmonicBalance(machine, longer), 3000 * RPM)
    assert solution.converged
    whole = np.abs(longer.amplitudes(solution.coefficients))
    fractional = np.array(longer.multiples) % revolutions != 0
    assert whole[fractional].max() < 1e-12
    expected = longer.change_from(plain.harmonics, plain.coefficients)
    assert solution.coefficients == pytest.approx(expected, abs=1e-10)
    motion = solution.journals["damper_1"]
    assert motion.eccentricity_max == pytest.approx(plain.eccentricity_max, rel=1e-6)
    group, _, _ = SelectedBalance(machine, longer, 1e-3).solve(3000 * RPM)
    assert all(multiple % revolutions == 0 for multiple in group)


def test_groups_out_of_range_are_refused():
    with pytest.raises(ValueError, match=r"multiples: \(1, 2\) .* rise from 0"):
        Harmonics(3).only((1, 2))
    with pytest.raises(ValueError, match="revolutions: 0"):
        Harmonics(3, revolutions=0)
    with pytest.raises(ValueError, match="tolerance: 0"):
        SelectedBalance(PAPER, Harmonics(3), 0)
