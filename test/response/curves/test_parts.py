"""Curves of machines whose films come near lock-up are whole over their range."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.random_machines import judge, random_case
from sfd_hbm_ros.cli import main
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override_all, read_machine
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.units import RPM

from ...hbm.machines import PAPER, UNBEARABLE

DEFECTS = Path(__file__).parents[2] / "defects"


@pytest.mark.parametrize("seed", [5, 9, 16, 26])
def test_sweep_of_a_random_machine_is_whole(seed):
    """The films of these lock up to more than 0.995 of the clearance within the range."""
    verdict = judge(random_case(seed), speeds=6)
    assert verdict.whole, verdict
    assert verdict.asked >= 4
    assert verdict.ends == [Stop.RANGE.name]


def test_points_beyond_0_995_balance_at_many_samples():
    """The film's force is steep there; with 16 times the samples it is the same."""
    case = random_case(9)
    balance = HarmonicBalance(case.machine, Harmonics(5))
    curve = response_curve(balance, case.lowest, 1.5 * case.lowest)
    close = [
        one
        for branch in curve.branches
        for one in branch.solutions
        if one.eccentricity_max > 0.995
    ]
    assert max(one.eccentricity_max for one in close) > 0.9995
    fine = HarmonicBalance(case.machine, Harmonics(5, samples=2048))
    for one in close:
        equations = fine.at(one.speed)
        residual = equations.residual(one.coefficients.ravel())
        assert np.linalg.norm(residual) < 1e-6 * equations.load


def test_parts_that_share_something_are_one_branch():
    """From each end there are too few points for the whole branch, but more than for half."""
    balance = HarmonicBalance(override_all(PAPER, {"gravity": True}), Harmonics(3))
    few = ContinuationOptions(points=40, longest_step=0.02)
    lowest, highest = 3700.0 * RPM, 4200.0 * RPM
    curve = response_curve(balance, lowest, highest, few)
    [branch] = curve.branches
    assert (branch.values[0], branch.values[-1]) == (lowest, highest)
    assert (branch.begin, branch.stop) == (Stop.RANGE, Stop.RANGE)
    assert len(branch.values) > 80
    assert curve.gaps == ()
    chords = np.diff(
        [one.unknowns / balance.machine.dampers[0].clearance for one in branch.solutions], axis=0
    )
    assert np.linalg.norm(chords, axis=1).max() < 0.05  # neither a leap nor a way back
    cosines = np.sum(chords[1:] * chords[:-1], axis=1)
    assert np.all(cosines > 0.0)


def test_range_begins_where_there_is_a_response():
    """Slowly turning, the unbalance cannot lift this machine's journals off their walls."""
    machine = read_machine(DEFECTS / "D5_sweep_start.json")
    lowest, highest = 300.0 * RPM, 2500.0 * RPM
    curve = response_curve(HarmonicBalance(machine, Harmonics(3)), lowest, highest)
    assert curve.gaps[0].low == lowest
    assert 900.0 * RPM < curve.gaps[0].high < 2200.0 * RPM
    assert curve.gaps[0].reason == Stop.CLEARANCE.value
    lowest_of_all = min(branch.values.min() for branch in curve.branches)
    assert lowest_of_all == curve.gaps[0].high
    assert max(branch.values.max() for branch in curve.branches) == highest


def test_a_branch_that_nearly_closes_comes_back():
    """Its eccentricity is above 0.995 from 1 500 to 1 800 rpm and again near 4 850 rpm."""
    machine = read_machine(DEFECTS / "D2_sweep_gap.json")
    lowest, highest = 1500.0 * RPM, 5200.0 * RPM
    curve = response_curve(HarmonicBalance(machine, Harmonics(5)), lowest, highest)
    [branch] = curve.branches
    assert (branch.values[0], branch.values[-1]) == (lowest, highest)
    assert branch.stable.all()
    later = branch.values > 4000.0 * RPM
    peak = branch.worst_eccentricity[later].argmax()
    assert branch.worst_eccentricity[later][peak] == pytest.approx(0.9985, abs=2e-4)
    assert branch.values[later][peak] == pytest.approx(4850.0 * RPM, rel=0.02)


def test_the_command_line_tells_where_there_is_no_response(capsys):
    machine = str(DEFECTS / "D5_sweep_start.json")
    command = ["sweep", machine, "--rpm", "300:2500", "--harmonics", "3"]
    assert main(command) == 0
    sentences = [line for line in capsys.readouterr().out.splitlines() if "no response" in line]
    assert sentences[0].startswith("no response was found from 300.00 rpm to ")
    assert sentences[0].endswith(" rpm: the orbit closes on the clearance")


def test_no_solution_anywhere_is_said():
    machine = override_all(PAPER, UNBEARABLE)
    balance = HarmonicBalance(machine, Harmonics(1))
    with pytest.raises(NoSolutionError, match=r"no solution at 2000 rpm: .* nor at the other end"):
        response_curve(balance, 2000.0 * RPM, 2500.0 * RPM)
