"""The operating point followed through folds, against closed-form orbits and curves' folds."""

from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import with_folds
from sfd_hbm_ros.hbm.family import LoadFamily
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.tracking.way import Way

from ...hbm.machines import PAPER, random_machine
from ...hbm.test_circular_orbit import circular_orbits

RPM = np.pi / 30.0
LOWEST, HIGHEST = 3850.0, 4095.0
INSIDE = 3998.0  # between both folds


@cache
def balance(unbalance=5.039e-4, force=0.0, viscosity=0.028):
    """The paper's rotor, unbalanced on disk 1, with the film whose force has a closed form."""
    changes = {
        "unbalance.disk_2.station": "disk_1",
        "unbalance.disk_2.magnitude": unbalance,
        "dampers.damper_1.film.inertia": False,
        "dampers.damper_1.viscosity": viscosity,
        "loads": [{"station": "disk_3", "force": [0.0, force]}],
    }
    return HarmonicBalance(override_all(PAPER, changes), Harmonics(3 if force else 1))


@cache
def curve(**changes):
    return response_curve(balance(**changes), LOWEST * RPM, HIGHEST * RPM)


@cache
def fold(direction):
    """Speed of the jump [rpm]."""
    [jump] = jumps(curve(), direction)
    return jump.value / RPM


def guided():
    tracker = Tracker(balance())
    tracker.adopt(curve())
    return tracker


@cache
def orbits(rpm):
    """Eccentricities of the closed form's orbits, those of the detached branch left out."""
    found = circular_orbits(balance().machine, balance().model, rpm * RPM, beside_folds=True)
    return [e for e, _ in found if e < 0.85]


def followed(tracker, speeds):
    """What the tracker says at speeds [rpm], all of which have to converge."""
    said = [tracker.predict(rpm * RPM) for rpm in speeds]
    assert [one.solution.message for one in said if not one.solution.converged] == []
    return said


@pytest.mark.parametrize("with_curve", [True, False], ids=["curve", "no curve"])
@pytest.mark.parametrize("step", [3.0, 11.0, 60.0, 200.0])
def test_run_up_and_coast_down_jump_once_each_at_the_fold(step, with_curve):
    tracker = guided() if with_curve else Tracker(balance())
    speeds = np.append(np.arange(LOWEST, HIGHEST, step), HIGHEST)
    for direction in Direction:
        on_upper = speeds < fold(direction)
        said = followed(tracker, speeds)
        after = np.flatnonzero(on_upper[1:] != on_upper[:-1]) + 1
        assert [i for i, one in enumerate(said) if one.jumped] == list(after)
        for rpm, upper, one in zip(speeds, on_upper, said, strict=True):
            expected = orbits(rpm)[-1 if upper else 0]
            assert one.solution.eccentricity_max == pytest.approx(expected, abs=1e-8)
        speeds = speeds[::-1]


def test_speed_that_wavers_about_a_fold_jumps_once():
    tracker, rng = guided(), np.random.default_rng(4)
    followed(tracker, [3900.0, 4000.0])
    noisy = fold(Direction.RUN_UP) + rng.normal(0.0, 0.5, 60)
    said = followed(tracker, noisy)
    first = int(np.flatnonzero(noisy > fold(Direction.RUN_UP))[0])
    assert [i for i, one in enumerate(said) if one.jumped] == [first]
    names = [one.branch for one in said]
    assert set(names[:first]) == {BranchName.UPPER}
    assert set(names[first:]) <= {BranchName.LOWER, BranchName.SINGLE}


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.integers(3960, 4036), min_size=1, max_size=8))
def test_any_journey_is_that_of_a_walk_in_small_steps_along_the_closed_form(goals):
    tracker = guided()
    at, high = 3900, True
    followed(tracker, [at])
    for goal in goals:
        step, before, walked = (1 if goal > at else -1), high, 0
        while at != goal:
            at += step
            if len(orbits(at)) == 1:
                below = at < fold(Direction.COAST_DOWN)
                walked += high != below
                high = below
        [said] = followed(tracker, [goal])
        assert said.jumped == (high != before) == bool(walked)
        assert said.solution.eccentricity_max == pytest.approx(orbits(at)[-high], abs=1e-8)
        expected = (BranchName.UPPER if high else BranchName.LOWER) if said.other else "single"
        assert said.branch == expected


def test_solution_and_the_other_are_those_of_independent_walks():
    tracker = guided()
    followed(tracker, [LOWEST])
    [said] = followed(tracker, [INSIDE])
    assert (said.branch, said.stable, said.current) == (BranchName.UPPER, True, True)
    for solution, start in ((said.solution, LOWEST), (said.other, HIGHEST)):
        known = None
        for rpm in np.linspace(start, INSIDE, 40):
            known = solve(balance(), rpm * RPM, known)
        difference = (solution.coefficients - known.coefficients) / balance().clearances
        assert np.abs(difference).max() < 1e-9


def test_place_is_where_the_curve_has_the_solution():
    tracker = guided()
    [said] = followed(tracker, [INSIDE])
    branch, index = said.place.branch, said.place.index
    assert branch in curve().branches
    assert min(branch.values[index : index + 2]) <= INSIDE * RPM
    assert max(branch.values[index : index + 2]) >= INSIDE * RPM
    assert said.place.eccentricity == pytest.approx(said.solution.eccentricity_max, abs=1e-3)


def test_start_without_a_history_is_unknown_until_it_is_settled():
    tracker = guided()
    [said] = followed(tracker, [INSIDE])
    assert (said.branch, tracker.settled) == (BranchName.UNKNOWN, False)
    assert said.solution.eccentricity_max > said.other.eccentricity_max
    tracker.settle(said.other)
    [settled] = followed(tracker, [INSIDE + 1.0])
    assert (settled.branch, settled.jumped) == (BranchName.LOWER, False)
    assert [one.branch for one in followed(tracker, [3900.0, INSIDE])] == ["single", "upper"]


def test_leaving_the_bistable_range_settles():
    tracker = guided()
    names = [one.branch for one in followed(tracker, [INSIDE, 3950.0, INSIDE])]
    assert names == [BranchName.UNKNOWN, BranchName.SINGLE, BranchName.UPPER]


@pytest.mark.parametrize(("start", "name"), [(3900.0, "upper"), (INSIDE - 5.0, "unknown")])
def test_curve_that_arrives_tells_the_branch_if_the_history_began_on_a_single_one(start, name):
    tracker = Tracker(balance())
    before = followed(tracker, np.arange(start, INSIDE, 4.0))
    assert {one.branch for one in before} == {BranchName.UNKNOWN}
    tracker.adopt(curve())
    [said] = followed(tracker, [INSIDE])
    assert (said.branch, said.current, said.jumped) == (name, True, False)


def test_forgetting_begins_anew():
    tracker = guided()
    followed(tracker, [3900.0, INSIDE])
    tracker.forget()
    [said] = followed(tracker, [INSIDE])
    assert (said.branch, tracker.settled) == (BranchName.UNKNOWN, False)


@cache
def unbalance_folds():
    """Unbalances between which there are three orbits at `INSIDE`, by bisection [kg m]."""

    def count(unbalance):
        one = balance(unbalance=unbalance)
        found = circular_orbits(one.machine, one.model, INSIDE * RPM)
        return len([e for e, _ in found if e < 0.85])

    bounds = []
    for outside in (4.5e-4, 6e-4):
        inside = 5.039e-4
        while abs(outside - inside) > 1e-9:
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if count(middle) == 3 else (inside, middle)
        bounds.append(inside)
    return bounds


@pytest.mark.parametrize("outdated", [True, False], ids=["outdated curve", "no curve"])
@pytest.mark.parametrize("steps", [1, 2, 12])
def test_unbalance_jumps_at_its_folds(steps, outdated):
    """In one step, in two and in many; the truth is the closed form."""
    least, most = unbalance_folds()
    tracker = guided() if outdated else Tracker(balance())
    followed(tracker, [3900.0, INSIDE])
    for end, landing in ((least - 5e-6, 0), (most + 5e-6, -1)):
        values = np.linspace(5.039e-4 if landing == 0 else least - 5e-6, end, steps + 1)[1:]
        said = []
        for unbalance in values:
            tracker.change(balance(unbalance=unbalance))
            said += followed(tracker, [INSIDE])
        beyond = values < least if landing == 0 else values > most
        assert [i for i, one in enumerate(said) if one.jumped] == [np.argmax(beyond)]
        one = balance(unbalance=end)
        found = circular_orbits(one.machine, one.model, INSIDE * RPM)
        expected = [e for e, _ in found if e < 0.85][landing]
        assert said[-1].solution.eccentricity_max == pytest.approx(expected, abs=1e-8)


@cache
def load_fold():
    """Load [N] on disk 3 at which the lower response at 3981 rpm folds, by arclength in it."""
    speed = 3981.0 * RPM
    without, loaded = (balance(force=force).at(speed) for force in (-1e-9, -200.0))
    family = LoadFamily(without, without.force, loaded.force - without.force)
    solution = None
    for rpm in np.linspace(HIGHEST, 3981.0, 60):
        solution = solve(without.balance, rpm * RPM, solution)
    branch = Branch(family, solution.coefficients.ravel(), 0.0, 1.0)
    [part] = [point.value for point, fold in with_folds(branch, branch) if fold]
    return 200.0 * part


@pytest.mark.parametrize("steps", [1, 3, 20])
def test_load_jumps_at_its_fold_and_not_back(steps):
    tracker = Tracker(balance(force=-1e-9))
    low = followed(tracker, np.linspace(HIGHEST, 3981.0, 60))[-1].solution.eccentricity_max
    loads = np.linspace(0.0, 200.0, steps + 1)[1:]
    said = []
    for load in [*loads, *loads[-2::-1], 1e-9]:
        tracker.change(balance(force=-load))
        said += followed(tracker, [3981.0])
    assert [i for i, one in enumerate(said) if one.jumped] == [np.argmax(loads > load_fold())]
    assert said[-1].solution.eccentricity_max == pytest.approx(orbits(3981.0)[-1], abs=1e-6)
    assert low == pytest.approx(orbits(3981.0)[0], abs=1e-6)


def test_machine_half_way_is_that_of_the_mean_numbers():
    start, middle, end = (balance(7e-4, f, v) for f, v in ((-10, 0.02), (-20, 0.03), (-30, 0.04)))
    at = Way(start, 3900 * RPM, end, 4000 * RPM).at(0.5)
    x = np.random.default_rng(1).uniform(-2e-5, 2e-5, at.force.size)
    expected = middle.at(3950 * RPM).residual(x)
    np.testing.assert_allclose(at.residual(x), expected, rtol=1e-9)


def test_outdated_curve_still_names_the_branch():
    tracker = guided()
    followed(tracker, [3900.0, INSIDE])
    tracker.change(balance(viscosity=0.0282))
    [said] = followed(tracker, [INSIDE])
    assert (said.branch, said.current, said.jumped) == (BranchName.UPPER, False, False)
    assert said.stable is None
    assert said.other.eccentricity_max < said.solution.eccentricity_max - 0.1
    tracker.adopt(curve(viscosity=0.0282))
    [later] = followed(tracker, [INSIDE])
    assert (later.branch, later.current, later.stable) == (BranchName.UPPER, True, True)
    difference = later.solution.coefficients - said.solution.coefficients
    assert np.abs(difference / balance().clearances).max() < 1e-9


def test_speeds_beyond_the_curve_are_predicted_and_it_is_found_again():
    tracker = guided()
    outside, inside = followed(tracker, [3700.0, 3900.0])
    assert (outside.branch, outside.place) == (BranchName.UNKNOWN, None)
    assert (inside.branch, inside.jumped) == (BranchName.SINGLE, False)


def test_solution_tells_the_history_of_its_residual_wherever_it_comes_from():
    for tracker in (guided(), Tracker(balance())):
        for said in followed(tracker, [3900.0, 3901.0, INSIDE, 4060.0, 4060.0]):
            assert said.solution.residuals[-1] <= 1e-10
            assert len(said.solution.residuals) == said.solution.iterations + 1


def test_speed_that_none_can_be_is_refused_in_words():
    said = guided().predict(-1.0)
    assert said.solution.message.startswith("speed: -1.0 rad/s is not allowed")


@pytest.mark.parametrize("speed", [np.nan, np.inf, -1.0, 0.0, 1e300])
def test_speed_without_a_solution_is_told_and_changes_nothing(speed):
    tracker = guided()
    followed(tracker, [3900.0, INSIDE])
    said = tracker.predict(speed)
    assert not said.solution.converged
    assert said.solution.message
    assert np.isnan(said.solution.coefficients).all()
    [after] = followed(tracker, [INSIDE])
    assert (after.branch, after.jumped) == (BranchName.UPPER, False)


def test_other_machine_altogether_is_solved_anew():
    tracker = guided()
    followed(tracker, [3900.0])
    other = HarmonicBalance(random_machine(3, dampers=2), Harmonics(3))
    tracker.change(other)
    [said] = followed(tracker, [2000.0])
    assert list(said.solution.journals) == ["damper_1", "damper_2"]


def test_settling_on_nothing_is_refused():
    tracker = guided()
    with pytest.raises(ValueError, match="there is no solution at nan rad/s to settle on"):
        tracker.settle(tracker.predict(np.nan).solution)
