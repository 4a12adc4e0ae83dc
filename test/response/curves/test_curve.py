"""Response curves, their jumps and their readings, on the paper's rotor and random machines."""

from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Instability, solve
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import parameter_curve, response_curve
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.place import solutions_at
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.errors import NoSolutionError

from ...hbm.machines import PAPER, UNBEARABLE, random_machine
from ...hbm.test_circular_orbit import PI_FILM, circular_orbits
from ...hbm.test_continuation import heavier
from ...hbm.test_uncondensed import uncondensed_residual

RPM = np.pi / 30.0


@cache
def paper_curve(disk, unbalance, gravity=False, harmonics=1, lowest=3500, highest=4500):
    changes = {
        "unbalance.disk_2.station": disk,
        "unbalance.disk_2.magnitude": unbalance,
        "gravity": gravity,
    }
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(harmonics))
    return response_curve(balance, lowest * RPM, highest * RPM)


def test_one_branch_with_two_folds():
    """Its unstable part lies just between the folds."""
    [branch] = paper_curve("disk_1", 5.039e-4).branches
    assert branch.stop is Stop.RANGE
    upper, lower = np.flatnonzero(branch.fold)
    assert not branch.stable[upper : lower + 1].any()
    assert branch.stable[:upper].all()
    assert branch.stable[lower + 1 :].all()
    assert {branch.instability[i] for i in range(upper, lower + 1)} == {Instability.FOLD}


def test_every_point_is_a_solution():
    curve = paper_curve("disk_2", 4.319e-4, gravity=True, harmonics=5)
    for branch in curve.branches:
        for solution in branch.solutions[::10]:
            # 1e-9 away from poles; the rounding of the condensation grows towards them
            assert uncondensed_residual(curve.balance, solution) < 1e-8


@pytest.mark.parametrize("disk", ["disk_1", "disk_3"])
def test_jumps_between_folds(disk):
    curve = paper_curve(disk, 5.039e-4)
    [branch] = curve.branches
    upper, lower = (branch.values[i] for i in np.flatnonzero(branch.fold))
    [up], [down] = (jumps(curve, direction) for direction in Direction)
    assert (up.value, down.value) == (upper, lower)
    machine, model = curve.balance.machine, curve.balance.model
    for jump, landing in ((up, 0), (down, -1)):
        orbits = [e for e, _ in circular_orbits(machine, model, jump.value) if e < 0.85]
        assert jump.after.eccentricity_max == pytest.approx(orbits[landing], abs=1e-7)
    assert up.before.eccentricity_max > up.after.eccentricity_max + 0.3
    assert down.before.eccentricity_max < down.after.eccentricity_max - 0.1
    assert Summary(curve).hysteresis == pytest.approx(upper - lower)


def test_branch_that_closes_on_the_clearance_is_left_there():
    curve = paper_curve("disk_2", 5.039e-4)
    upper, lower, leaving = curve.branches
    assert {one.stop for one in (upper, lower, leaving)} == {Stop.CLEARANCE}
    [up], [down] = (jumps(curve, direction) for direction in Direction)
    assert up.value == leaving.values[-1]
    assert up.before.eccentricity_max > 0.99
    assert down.value == pytest.approx(3985.45 * RPM, abs=0.05 * RPM)
    assert Summary(curve).amplification_factor is None


def test_upper_branch_loses_stability_before_it_closes():
    curve = paper_curve("disk_2", 5.039e-4)
    [(kind, mark)] = [
        one for one in Summary(curve).instabilities if one[0] is not Instability.FOLD
    ][:1]
    assert kind is Instability.NEIMARK_SACKER
    assert 4125.0 * RPM < mark.value < 4140.0 * RPM


def test_no_jump_without_a_fold():
    curve = paper_curve("disk_2", 3e-4)
    assert [jumps(curve, direction) for direction in Direction] == [[], []]
    summary = Summary(curve)
    assert summary.folds == []
    assert summary.hysteresis is None
    highest = curve.branches[0].worst_eccentricity.max()  # of the points beside the peak
    assert highest < summary.peak.eccentricity < 1.001 * highest


def test_amplification_factor_is_that_of_the_curve_sampled_evenly():
    curve = paper_curve("disk_2", 3e-4)
    speeds = np.arange(3500.0, 4500.0, 2.0) * RPM
    solution, eccentricity = None, []
    for speed in speeds:
        solution = solve(curve.balance, speed, start=solution)
        eccentricity.append(solution.eccentricity_max)
    above = speeds[np.array(eccentricity) > max(eccentricity) / np.sqrt(2.0)]
    expected = speeds[np.argmax(eccentricity)] / (above[-1] - above[0])
    assert Summary(curve).amplification_factor == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize(
    ("machine", "lowest", "highest"),
    [(PAPER, 3500 * RPM, 4500 * RPM), (heavier(random_machine(612, film=PI_FILM), 2.0), 400, 700)],
    ids=["paper", "random"],
)
def test_detached_branches_complete_the_closed_form(machine, lowest, highest):
    """Every circular orbit lies on the response curve or on a detached branch, and is found."""
    curve = response_curve(HarmonicBalance(machine, Harmonics(1)), lowest, highest)
    detached = detached_branches(curve, lowest, highest, 5)
    assert len(detached) == 1
    assert detached[0].worst_eccentricity.min() > 0.85
    for speed in np.linspace(lowest, highest, 24)[1:-1]:
        expected = [e for e, _ in circular_orbits(machine, curve.balance.model, speed) if e < 0.99]
        found = sorted(
            solution.eccentricity_max
            for branch in (*curve.branches, *detached)
            for _, solution in solutions_at(branch, speed)
        )
        assert [e for e in found if e < 0.99] == pytest.approx(expected, abs=1e-7)


def test_jumps_in_the_unbalance():
    """At one speed between the folds the unbalance itself makes the machine jump."""
    balance = HarmonicBalance(PAPER, Harmonics(1))
    curve = parameter_curve(balance, 4000 * RPM, "unbalance.disk_2.magnitude", 2e-4, 7e-4)
    [up], [down] = (jumps(curve, direction) for direction in Direction)
    assert down.value < 5.039e-4 < up.value
    assert up.after.eccentricity_max > up.before.eccentricity_max + 0.15
    assert down.after.eccentricity_max < down.before.eccentricity_max - 0.1


def test_curve_without_a_solution_is_refused():
    balance = HarmonicBalance(override_all(PAPER, UNBEARABLE), Harmonics(1))
    with pytest.raises(NoSolutionError, match="no solution at 3500 rpm: the load could not"):
        response_curve(balance, 3500 * RPM, 4500 * RPM)
