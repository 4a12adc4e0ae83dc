"""Jumps in time: those that harmonic balance predicts, and what is none."""

from dataclasses import replace

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import Unbalance
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.integration.integrator import Integrator, State
from sfd_hbm_ros.response.integration.observed import ObservedJump, observed_jumps
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import Transient, run

from ...hbm.machines import PAPER

RPM = np.pi / 30.0

#: The paper's rotor with 503.9 g mm on disk 3: its main branch folds at 4033 and 3981 rpm.
BISTABLE = HarmonicBalance(
    replace(PAPER, unbalance=(Unbalance("disk_3", 5.039e-4, 0.0),)), Harmonics(3)
)


@pytest.fixture(scope="module")
def folds():
    """Speeds of the folds [rad/s] and their eccentricities, in the order of a run-up."""
    [branch] = response_curve(BISTABLE, 3900.0 * RPM, 4100.0 * RPM).branches
    return [(branch.values[i], branch.worst_eccentricity[i]) for i in np.flatnonzero(branch.fold)]


def jump_of_a_run(start, end):
    """The only jump of a slow run, begun on the branch that leads there."""
    first = 3900.0 * RPM if end > start else start
    solution = None
    for speed in np.linspace(first, start, 30):
        solution = solve(BISTABLE, speed, solution)
    integrator = Integrator(BISTABLE, max(start, end))
    ramp = Ramp.between(start, end, 5.0 * RPM)
    [jump] = observed_jumps(run(integrator, ramp, integrator.start(solution)))
    return jump


def test_run_up_jumps_at_the_fold_of_the_upper_branch(folds):
    fold, eccentricity = folds[0]
    jump = jump_of_a_run(fold - 5.0 * RPM, fold + 20.0 * RPM)
    assert jump.direction is Direction.RUN_UP
    assert 0.0 < jump.speed / fold - 1.0 < 0.005
    assert jump.eccentricity_from == pytest.approx(eccentricity, abs=0.05)
    after = solve(BISTABLE, fold + 20.0 * RPM).journals["damper_1"].eccentricity_max
    assert jump.eccentricity_to == pytest.approx(after, abs=0.05)


def test_coast_down_jumps_at_the_fold_of_the_lower_branch(folds):
    fold, eccentricity = folds[1]
    jump = jump_of_a_run(fold + 5.0 * RPM, fold - 20.0 * RPM)
    assert jump.direction is Direction.COAST_DOWN
    assert -0.005 < jump.speed / fold - 1.0 < 0.0
    assert jump.eccentricity_from == pytest.approx(eccentricity, abs=0.05)
    after = solve(BISTABLE, fold - 20.0 * RPM).journals["damper_1"].eccentricity_max
    assert jump.eccentricity_to == pytest.approx(after, abs=0.05)


def transient(acceleration, eccentricity):
    """A run from 400 rad/s with given eccentricities of 2000 revolutions."""
    ramp = Ramp(400.0, acceleration, 2000)
    part = np.linspace(0.0, 1.0, 2000)
    values = {"damper_1": eccentricity(part), "damper_2": np.full(2000, 0.1)}
    nothing = State(np.zeros(0), np.zeros(0), np.zeros(0))
    return Transient(ramp, values, values, {}, nothing)


@pytest.mark.parametrize("acceleration", [-0.5, 0.5])
def test_sudden_changes_are_jumps(acceleration):
    found = transient(
        acceleration, lambda part: np.where(part < 0.3, 0.5, np.where(part < 0.8, 0.9, 0.4))
    )
    direction = Direction.RUN_UP if acceleration > 0.0 else Direction.COAST_DOWN
    speed = found.speed
    at = [0.5 * (speed[i] + speed[i - 1]) for i in (600, 1600)]
    assert observed_jumps(found) == [
        ObservedJump(direction, pytest.approx(at[0]), pytest.approx(0.5), pytest.approx(0.9)),
        ObservedJump(direction, pytest.approx(at[1]), pytest.approx(0.9), pytest.approx(0.4)),
    ]


@pytest.mark.parametrize(
    "eccentricity",
    [
        lambda part: 0.1 + 0.7 * part,
        lambda part: 0.5 + 0.2 * np.sin(2.0 * np.pi * 200.0 * part),
        lambda part: np.where(part < 0.5, 0.5, 0.54),
    ],
    ids=["slope", "beat", "small"],
)
def test_slopes_beats_and_small_steps_are_none(eccentricity):
    assert observed_jumps(transient(0.5, eccentricity)) == []


def test_fast_run_has_none():
    """At 40 rad/s2 the speed of 400 rad/s changes by 0.25 % in 1.6 revolutions."""
    assert observed_jumps(transient(40.0, lambda part: np.where(part < 0.5, 0.5, 0.9))) == []


def test_constant_speed_has_no_jumps():
    found = transient(0.0, lambda part: np.where(part < 0.5, 0.2, 0.8))
    assert observed_jumps(found) == []
