"""The jumps ahead, against the closed form of circular orbits followed step by step.

The film is without inertia, for which the closed form is fastest.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import (
    HarmonicBalance,
    Harmonics,
    Instability,
    JournalMotion,
    Outcome,
    Solution,
)
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.forks import Fork
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.place import places_at
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.warning.jump_map import jump_map
from sfd_hbm_ros.response.warning.outlook import JumpAhead, Outlook, unknown_outlook

from ...hbm.machines import PAPER
from ...hbm.test_circular_orbit import circular_orbits

RPM = np.pi / 30.0
STEP = 1.0 * RPM  # of the closed form's journeys
LOWEST, HIGHEST = 3700, 4300


@cache
def curve_of(disk):
    """The paper's rotor with 503.9 g mm on a disk, which jumps."""
    changes = {
        "unbalance.disk_2.station": disk,
        "unbalance.disk_2.magnitude": 5.039e-4,
        "dampers.damper_1.film.inertia": False,
    }
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(1))
    return response_curve(balance, LOWEST * RPM, HIGHEST * RPM)


@cache
def map_of(disk):
    return jump_map(curve_of(disk))


@cache
def orbits(disk, step):
    """All eccentricities of circular orbits after a number of steps of the speed."""
    curve = curve_of(disk)
    speed = LOWEST * RPM + step * STEP
    found = circular_orbits(curve.balance.machine, curve.balance.model, speed, beside_folds=True)
    return np.array([e for e, _ in found])


def journey(disk, step, eccentricity, sign):
    """Steps of the last orbit on the way up or down, and the eccentricities before and after.

    From each speed to the next the orbit is the nearest one, and beyond that a jump.
    """
    while 0 <= step + sign <= (HIGHEST - LOWEST):
        following = orbits(disk, step + sign)
        nearest = following[np.argmin(np.abs(following - eccentricity))]
        if abs(nearest - eccentricity) > 0.08:
            return step, eccentricity, nearest
        step, eccentricity = step + sign, nearest
    return None


def places(disk, speed):
    """Stable places at a speed, the least eccentricity first."""
    found = [one for one in places_at(curve_of(disk).branches, speed) if one.stable]
    return sorted(found, key=lambda place: place.eccentricity)


# jumps: of disk 2 at 3989 and 4162 rpm, of disk 1 at 3979 and 4017 rpm; the run-up on the upper
# circle of disk 2 becomes quasi-periodic before
@pytest.mark.parametrize(
    ("disk", "rpm", "which", "sign"),
    [
        (*place, sign)
        for place, signs in {
            ("disk_2", 3800, 0): (-1,),
            ("disk_2", 4000, 0): (1, -1),
            ("disk_2", 4000, 1): (-1,),
            ("disk_2", 4120, 0): (1, -1),
            ("disk_2", 4250, 0): (1, -1),
            ("disk_1", 3900, 0): (1, -1),
            ("disk_1", 3990, 0): (1, -1),
            ("disk_1", 3990, 1): (1, -1),
            ("disk_1", 4100, 0): (1, -1),
        }.items()
        for sign in signs
    ],
)
def test_jump_ahead_is_where_the_orbit_ends(disk, rpm, which, sign):
    place = places(disk, rpm * RPM)[which]
    outlook = map_of(disk).outlook(place, 2.0 * sign)
    expected = journey(disk, rpm - LOWEST, place.eccentricity, sign)
    if expected is None:
        assert outlook.margin == math.inf
        assert outlook.time_to_jump == math.inf
        return
    last, before, after = expected
    found = (outlook.next.speed - LOWEST * RPM) / STEP
    assert -1e-6 <= sign * (found - last) <= 1.0
    # within a step before a fold e changes by up to 0.06; the landing is interpolated on the curve
    assert outlook.next.eccentricity_before == pytest.approx(before, abs=0.06)
    landings = orbits(disk, found)
    landing = landings[np.argmin(np.abs(landings - after))]
    assert outlook.next.eccentricity_after == pytest.approx(landing, abs=1e-3)
    assert outlook.margin == pytest.approx(abs(outlook.next.speed - rpm * RPM))
    assert outlook.relative_margin == pytest.approx(outlook.margin / (rpm * RPM))
    assert outlook.time_to_jump == pytest.approx(outlook.margin / 2.0)


def test_jump_ahead_is_where_the_quasi_periodic_branch_ends():
    """Onto it the run-up moves without a jump, and back from it the coast-down."""
    curve = curve_of("disk_2")
    upper, _, leaving = curve.branches
    assert leaving.stable.all()
    [(onset, _)] = curve.meeting(leaving, 0)
    assert onset is upper
    for rpm in (3800, 4000, 4120, 4150):
        place = places("disk_2", rpm * RPM)[-1]
        assert place.branch is (leaving if place.value > leaving.values[0] else upper)
        outlook = map_of("disk_2").outlook(place, 1.0)
        assert outlook.run_up.speed == leaving.values[-1] < upper.values[-1]
        assert outlook.run_up.eccentricity_before == leaving.worst_eccentricity[-1]
        landings = orbits("disk_2", (leaving.values[-1] - LOWEST * RPM) / STEP)
        assert outlook.run_up.eccentricity_after == pytest.approx(landings[0], abs=1e-3)
        assert outlook.coast_down.speed == math.inf


def test_stretch_beyond_a_fork_where_no_stable_branch_leads_on_jumps_there():
    """An unstable branch leaves, so that the machine jumps at the fork and lands beyond it."""
    curve = curve_of("disk_1")
    lost = circles([390.0, 410.0, 430.0], [0.3, 0.4, 0.5], [1, 2], Stop.RANGE)
    leaving = circles([410.0, 400.0, 390.0], [0.4, 0.45, 0.5], [0, 1, 2], Stop.RANGE)
    other = circles([390.0, 430.0], [0.8, 0.9], [], Stop.RANGE)
    fork = Fork(((lost, 1), (leaving, 0)))
    found = jump_map(ResponseCurve(curve.balance, curve.family, (lost, leaving, other), (fork,)))
    [place] = places_at([lost], 400.0)
    ahead = found.outlook(place, 1.0).next
    assert (ahead.speed, ahead.eccentricity_before) == (410.0, pytest.approx(0.4))
    assert ahead.eccentricity_after == pytest.approx(0.85)
    assert found.outlook(place, -1.0).margin == math.inf


@pytest.mark.parametrize("rpm", [3750, 3988, 3990, 4005, 4100, 4130, 4200])
def test_bistable_where_there_are_three_orbits(rpm):
    """The middle one of three is unstable; the others are stable up to 4133 rpm."""
    disk = "disk_2"
    for place in places(disk, rpm * RPM):
        outlook = map_of(disk).outlook(place, 1.0)
        assert outlook.bistable == (len(orbits(disk, rpm - LOWEST)) == 3)


@pytest.mark.parametrize("disk", ["disk_1", "disk_2"])
def test_jumps_of_a_whole_journey(disk):
    """From both ends of the range the map shows what following the curve found."""
    for direction, rpm, acceleration in (
        (Direction.RUN_UP, LOWEST + 1, 1.0),
        (Direction.COAST_DOWN, HIGHEST - 1, -1.0),
    ):
        [jump] = jumps(curve_of(disk), direction)
        [place] = places(disk, rpm * RPM)
        found = map_of(disk).outlook(place, acceleration).next
        assert (found.direction, found.speed) == (direction, jump.value)
        assert found.upwards == (direction is Direction.COAST_DOWN)
        after = jump.after.eccentricity_max
        assert found.eccentricity_after == pytest.approx(after, abs=2e-3)


def circles(values, eccentricities, unstable, stop):
    """A branch through circular orbits of given eccentricities."""
    balance = curve_of("disk_1").balance
    [damper] = balance.machine.dampers
    size = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) * damper.clearance
    solutions = tuple(
        Solution(
            value,
            balance.harmonics,
            Outcome.CONVERGED,
            "",
            (),
            {
                damper.name: JournalMotion(
                    damper.name, damper.clearance, balance.harmonics, e * size
                )
            },
        )
        for value, e in zip(values, eccentricities, strict=True)
    )
    kinds = tuple(Instability.FOLD if i in unstable else None for i in range(len(values)))
    folds = np.zeros(len(values), bool)
    return CurveBranch(SpeedFamily(balance), np.array(values), solutions, kinds, folds, stop)


def ring(start):
    """A closed branch from 400 to 430 rad/s, entered at one of its points."""
    arc = [
        (400.0, 0.92),
        (410.0, 0.90),
        (420.0, 0.91),
        (430.0, 0.93),
        (420.0, 0.95),
        (410.0, 0.94),
    ]
    arc = [*arc[start:], *arc[:start], arc[start]]
    unstable = [i for i, (value, e) in enumerate(arc) if e >= 0.94 or value in (400.0, 430.0)]
    return circles(*zip(*arc, strict=True), unstable, Stop.CLOSED)


@pytest.mark.parametrize("start", range(6))
def test_closed_branch_ends_at_its_folds_wherever_it_is_entered(start):
    below = circles([390.0, 440.0], [0.3, 0.5], [], Stop.RANGE)
    curve = curve_of("disk_1")
    closed = ring(start)
    found = jump_map(ResponseCurve(curve.balance, curve.family, (below, closed)))
    for place in places_at([closed], 415.0):
        outlook = found.outlook(place, math.nan)
        assert (outlook.coast_down.speed, outlook.run_up.speed) == (400.0, 430.0)
        assert outlook.run_up.eccentricity_after == pytest.approx(0.46)
        assert not outlook.run_up.upwards
    [main] = places_at([below], 415.0)
    assert found.outlook(main, 1.0).bistable
    assert found.outlook(main, 1.0).margin == math.inf


def test_hysteresis_is_between_jumps_that_belong_together():
    """Up at 420 and 450 rad/s, down at 440 and 405: the first jumps of both ways do not."""
    curve = curve_of("disk_1")
    low = circles([390.0, 420.0], [0.2, 0.3], [], Stop.CLEARANCE)
    middle = circles([405.0, 450.0], [0.5, 0.6], [], Stop.CLEARANCE)
    high = circles([460.0, 440.0], [0.8, 0.9], [], Stop.CLEARANCE)
    whole = ResponseCurve(curve.balance, curve.family, (low, middle, high))
    summary = Summary(whole)
    assert [jump.value for jump in summary.jumps] == [420.0, 450.0, 440.0, 405.0]
    assert summary.hysteresis == 15.0
    assert Summary(replace(whole, branches=(low,))).hysteresis is None


@pytest.mark.parametrize(
    ("stop", "speed"), [(Stop.CLEARANCE, 430.0), (Stop.STEP, math.nan), (Stop.POINTS, math.nan)]
)
def test_branch_that_ends_within_the_range(stop, speed):
    """Where it was lost nobody knows what follows, and nowhere to land is not an eccentricity."""
    curve = curve_of("disk_1")
    lost = circles([390.0, 430.0], [0.3, 0.9], [], stop)
    other = circles([440.0, 435.0], [0.3, 0.4], [], Stop.CLEARANCE)
    found = jump_map(ResponseCurve(curve.balance, curve.family, (lost, other)))
    [place] = places_at([lost], 400.0)
    ahead = found.outlook(place, 1.0).next
    assert ahead.speed == pytest.approx(speed, nan_ok=True)
    assert math.isnan(ahead.eccentricity_after)


@pytest.mark.parametrize(
    ("fold", "after", "back", "speed"),
    [
        (410.0, 0.41, 408.0, 430.0),  # by less than a hundredth of the clearance
        (410.0, 0.6, 410.0 - 0.05 * RPM, 430.0),  # undone by a twentieth of a rpm
        (410.0, 0.6, 409.0, 410.0),
        (410.0, 0.42, 408.0, 410.0),
    ],
)
def test_a_jump_that_nobody_would_notice_is_passed_over(fold, after, back, speed):
    """Up to a fold, on from where it lands to the jump there, and on to a third branch."""
    curve = curve_of("disk_1")
    first = circles([390.0, fold], [0.3, 0.405], [1], Stop.CLEARANCE)
    second = circles([back, 430.0], [after, after + 1e-4], [0], Stop.CLEARANCE)
    third = circles([420.0, 440.0], [0.1, 0.1], [], Stop.RANGE)
    found = jump_map(ResponseCurve(curve.balance, curve.family, (first, second, third)))
    [place] = places_at([first], 400.0)
    ahead = found.outlook(place, 1.0).next
    assert ahead.speed == speed
    assert ahead.leading.damper == "damper_1"
    if speed == fold:
        assert ahead.leading[1:] == (pytest.approx(0.405), pytest.approx(after, abs=1e-3))


@pytest.mark.parametrize("acceleration", [0.0, 1.0, -1.0])
def test_of_a_machine_on_an_unknown_response_both_outlooks_are_told(acceleration):
    """The nearer jump comes first."""
    speed = 3990 * RPM
    known = [map_of("disk_1").outlook(one, acceleration) for one in places("disk_1", speed)]
    any_of_both = map_of("disk_1").outlook_of_any(speed, acceleration)
    told = [any_of_both, *any_of_both.others]
    assert len(known) == len(told) == 2
    assert any_of_both.margin == min(one.margin for one in known)
    for one in known:
        [same] = [other for other in told if other.eccentricity == one.eccentricity]
        assert (same.run_up, same.coast_down) == (one.run_up, one.coast_down)
    single = map_of("disk_1").outlook_of_any(3900 * RPM, acceleration)
    assert single.others == ()
    assert math.isnan(map_of("disk_1").outlook_of_any(3600 * RPM, acceleration).margin)


def test_place_on_another_curve_is_not_computable():
    [place] = places("disk_1", 3900 * RPM)
    outlook = map_of("disk_2").outlook(place, 1.0)
    assert outlook.bistable is None
    assert math.isnan(outlook.margin)


def made(acceleration, run_up=450.0, coast_down=395.0):
    ends = JumpAhead(Direction.RUN_UP, run_up), JumpAhead(Direction.COAST_DOWN, coast_down)
    return Outlook(400.0, acceleration, True, *ends)


@pytest.mark.parametrize(
    ("acceleration", "margin", "time"),
    [
        (2.0, 50.0, 25.0),
        (-2.0, 5.0, 2.5),
        (0.0, 5.0, math.inf),
        (math.nan, 5.0, math.nan),
    ],
)
def test_next_jump_is_that_in_the_direction_of_travel(acceleration, margin, time):
    """The nearer one where the speed is steady or nothing is known about its direction."""
    outlook = made(acceleration)
    assert outlook.margin == pytest.approx(margin)
    assert outlook.time_to_jump == pytest.approx(time, nan_ok=True)


@pytest.mark.parametrize(
    ("run_up", "coast_down", "expected"),
    [
        (math.inf, math.inf, math.inf),
        (math.nan, math.inf, math.nan),
        (math.inf, math.nan, math.nan),
        (math.nan, 390.0, 10.0),
    ],
)
def test_at_a_steady_speed_what_is_known_comes_first(run_up, coast_down, expected):
    assert made(0.0, run_up, coast_down).margin == pytest.approx(expected, nan_ok=True)


def test_no_time_is_told_before_the_acceleration_has_settled():
    assert math.isnan(replace(made(2.0), settled=False).time_to_jump)
    assert replace(made(0.0), settled=False).time_to_jump == math.inf
    assert replace(made(2.0, run_up=math.inf), settled=False).time_to_jump == math.inf


def test_a_jump_that_has_been_passed_is_no_distance_ahead():
    assert made(1.0, run_up=399.0).margin == 0.0
    assert made(1.0, run_up=399.0).time_to_jump == 0.0


def test_nothing_is_known_without_a_curve():
    outlook = unknown_outlook(400.0, 1.0)
    assert (outlook.run_up.direction, outlook.coast_down.direction) == tuple(Direction)
    values = outlook.margin, outlook.relative_margin, outlook.time_to_jump
    assert np.isnan(values).all()
    assert outlook.bistable is None
