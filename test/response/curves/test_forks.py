"""Responses of two revolutions on a response curve: where they begin, and the jumps they make."""

from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Instability
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.response.curves.journey import first_place, travel
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.warning.jump_map import jump_map

from ...hbm.machines import misaligned_rotor
from ...hbm.test_uncondensed import uncondensed_residual

#: Changes after which the period doubling is subcritical.
LIGHTER = {"dampers.damper.viscosity": 0.008, "unbalance.disk.magnitude": 3.6e-4}


@cache
def curve(lowest, highest, lighter=False):
    machine = override_all(misaligned_rotor(), LIGHTER if lighter else {})
    return response_curve(HarmonicBalance(machine, Harmonics(5)), lowest, highest)


def integrated(solution, speed, revolutions):
    """Greatest eccentricity in each revolution at a speed, begun with a response."""
    balance = HarmonicBalance(misaligned_rotor(), Harmonics(5))
    ramp, integrator = Ramp(speed, 0.0, revolutions), Integrator(balance, speed)
    state, found = integrator.start(solution), []
    for number in range(revolutions):
        state, positions = integrator.revolution(ramp, number, state)
        found.append(np.linalg.norm(positions, axis=1).max() / balance.clearances[0])
    return np.array(found)


def test_branch_between_two_period_doublings_joins_at_both():
    synchronous, doubled = curve(700.0, 1460.0).branches
    assert doubled.stop is Stop.JOINED
    first, last = np.flatnonzero(
        [kind is Instability.PERIOD_DOUBLING for kind in synchronous.instability]
    )[[0, -1]]
    assert synchronous.stable[:first].all()
    assert synchronous.stable[last + 1 :].all()
    assert (doubled.values[0], doubled.values[-1]) == (
        synchronous.values[first],
        synchronous.values[last],
    )
    for end, point in ((0, first), (-1, last)):
        ends = doubled.solutions[end], synchronous.solutions[point]
        assert ends[0].harmonics.revolutions == 2 * ends[1].harmonics.revolutions
        assert ends[0].eccentricity_max == pytest.approx(ends[1].eccentricity_max, rel=1e-6)


def test_every_point_is_a_solution():
    doubled = curve(750.0, 1300.0).branches[1]
    balance = doubled.family.at(1000.0).balance
    for solution in doubled.solutions[::5]:
        assert uncondensed_residual(balance, solution) < 1e-8


def test_machine_moves_smoothly_onto_a_stable_branch():
    """A run-up never jumps; the way down does at the fold of the branch met first."""
    one = curve(750.0, 1300.0)
    assert jumps(one, Direction.RUN_UP) == []
    [down] = jumps(one, Direction.COAST_DOWN)
    _, upper, lower = one.branches
    [fold] = np.flatnonzero(lower.fold)
    assert down.value == lower.values[fold]
    assert down.before is lower.solutions[fold]
    assert down.after.harmonics.revolutions == 2
    assert down.after.eccentricity_max == pytest.approx(
        np.interp(down.value, upper.values, upper.worst_eccentricity), abs=1e-3
    )


def test_jump_from_the_fold_in_time():
    """0.3 % above the fold the machine stays, as far below it lands on the other branch."""
    [down] = jumps(curve(750.0, 1300.0), Direction.COAST_DOWN)
    above = integrated(down.before, 1.003 * down.value, 40)
    below = integrated(down.before, 0.997 * down.value, 120)
    assert above[-2:].max() < down.before.eccentricity_max
    assert below[-2:].max() == pytest.approx(down.after.eccentricity_max, abs=0.005)


def test_machine_jumps_where_the_branch_that_leaves_is_unstable():
    one = curve(720.0, 860.0, lighter=True)
    _, doubled = one.branches
    assert not doubled.stable[:5].any()
    [down] = jumps(one, Direction.COAST_DOWN)
    assert down.value == doubled.values[0]
    assert down.before.harmonics.revolutions == 1
    assert down.after.harmonics.revolutions == 2
    assert down.after.eccentricity_max > down.before.eccentricity_max + 0.2
    [up] = jumps(one, Direction.RUN_UP)
    assert doubled.fold[doubled.values == up.value].all()
    assert (up.before.harmonics.revolutions, up.after.harmonics.revolutions) == (2, 1)
    assert Summary(one).hysteresis == pytest.approx(up.value - down.value)


@pytest.mark.parametrize("direction", Direction)
def test_jumps_ahead_are_those_of_the_journey(direction):
    """Wherever the machine is on its way, the map tells the next jump, and none at a fork."""
    one = curve(750.0, 1300.0)
    found, rising = jump_map(one), direction is Direction.RUN_UP
    expected = [jump.value for jump in jumps(one, direction)]
    start = first_place(one.branches, rising)
    for speed in np.linspace(755.0, 1295.0, 55)[:: 1 if rising else -1]:
        there = travel(one, start, speed).place
        ahead = found.outlook(there, 1.0 if rising else -1.0).next
        left = [value for value in expected if (value > speed) == rising]
        assert ahead.speed == (left[0] if left else direction.end * (1.0 if rising else -1.0))


def test_tracker_moves_onto_the_responses_of_two_revolutions():
    """The run-up never jumps; the way down from the lower response does once, at its fold."""
    one = curve(750.0, 1300.0)
    tracker = Tracker(one.balance)
    tracker.adopt(one)
    [down] = jumps(one, Direction.COAST_DOWN)
    up = [tracker.predict(speed) for speed in np.linspace(760.0, 1290.0, 30)]
    assert all(said.solution.converged and said.stable for said in up)
    assert not any(said.jumped for said in up)
    assert {said.solution.harmonics.revolutions for said in up} == {1, 2}
    tracker.settle(up[-1].other)
    way = np.linspace(1290.0, 760.0, 30)
    back = [tracker.predict(speed) for speed in way]
    [jumped] = [i for i, said in enumerate(back) if said.jumped]
    assert way[jumped] < down.value < way[jumped - 1]
    assert all(said.stable for said in back)


def test_detached_branches_beside_responses_of_two_revolutions():
    """What the curve holds is not found again; what is found is a response in time too."""
    one = curve(750.0, 1300.0)
    unstable, stable = detached_branches(one, 950.0, 1050.0, speeds=3)
    assert not unstable.stable.any()
    assert stable.stable.all()
    speed = 1000.0
    eccentricity = np.interp(speed, stable.values, stable.worst_eccentricity)
    assert eccentricity > 0.88
    in_time = integrated(stable.solutions[0], speed, 60)
    assert in_time[-1] == pytest.approx(eccentricity, abs=1e-3)
