"""Pseudo-arclength continuation against the closed-form circular orbit, and its ends."""

import dataclasses
import itertools

import numpy as np
import pytest
from scipy.optimize import fsolve

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate, with_folds
from sfd_hbm_ros.hbm.family import LoadFamily, ParameterFamily, SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override, override_all

from .machines import PAPER, random_machine
from .test_circular_orbit import PI_FILM, circular_orbits, excess

RPM = np.pi / 30.0


def follow(machine, start, end, harmonics=3, **options):
    balance = HarmonicBalance(machine, Harmonics(harmonics))
    first = solve(balance, start)
    assert first.converged
    settings = ContinuationOptions(**options)
    return Branch(SpeedFamily(balance), first.coefficients.ravel(), start, end, options=settings)


def heavier(machine, factor):
    unbalance = tuple(
        dataclasses.replace(one, magnitude=factor * one.magnitude) for one in machine.unbalance
    )
    return dataclasses.replace(machine, unbalance=unbalance)


def closed_form_fold(machine, model, fold):
    """Speed at which the circular orbit's equation and its derivative by e vanish together."""

    def conditions(unknowns):
        w, e, h = unknowns[0] * fold.value, unknowns[1], 1e-5
        scale = excess(machine, model, w, 0.5) - excess(machine, model, w, 0.0)
        ahead, behind = (excess(machine, model, w, e + side * h) for side in (1, -1))
        return excess(machine, model, w, e) / scale, (ahead - behind) / (2.0 * h * scale)

    start = (1.0002, fold.eccentricity + 0.002)
    found, _, status, message = fsolve(conditions, start, xtol=1e-12, full_output=True)
    assert status == 1, message
    return found[0] * fold.value


@pytest.mark.parametrize(
    ("seed", "count"),
    [(605, 2), (606, 2), (624, 2), (629, 2), (601, 0), (609, 0), (616, 0), (620, 0)],
)
def test_folds_are_those_of_the_closed_form(seed, count):
    machine = heavier(random_machine(seed, film=PI_FILM), 2.0)
    branch = follow(machine, 100.0, 900.0, harmonics=1)
    points = list(with_folds(branch, branch))
    assert branch.stop is Stop.RANGE
    model = branch.family.balance.model
    folds = [point for point, is_fold in points if is_fold]
    assert len(folds) == count
    for fold in folds:
        assert fold.value == pytest.approx(closed_form_fold(machine, model, fold), abs=1e-6 * RPM)
        assert abs(fold.tangent[-1]) < 1e-4
    if not folds:
        for w in np.linspace(101.0, 899.0, 100):
            assert len(circular_orbits(machine, model, w)) == 1


@pytest.mark.parametrize("seed", [603, 610])
def test_branch_closes_on_the_clearance(seed):
    """Every point up to an eccentricity of 0.99 lies on the closed-form curve."""
    machine = heavier(random_machine(seed, film=PI_FILM), 2.0)
    branch = follow(machine, 100.0, 900.0, harmonics=1, eccentricity=0.99)
    points = list(branch)
    assert branch.stop is Stop.CLEARANCE
    assert points[-1].eccentricity > 0.99
    model = branch.family.balance.model
    for point in points[::3] + points[-1:]:
        nearest = min(
            abs(e - point.eccentricity) for e, _ in circular_orbits(machine, model, point.value)
        )
        assert nearest < 1e-7


def test_undamped_pole_is_passed():
    """The pinned-pinned critical speed of the paper's rotor, 4 162 rpm, is a pole of Eq. 10."""
    branch = follow(PAPER, 4000 * RPM, 4400 * RPM)
    points = list(branch)
    assert branch.stop is Stop.RANGE
    assert points[-1].value == 4400 * RPM
    for point in points[::4]:
        [(e, _)] = circular_orbits(PAPER, branch.family.balance.model, point.value)
        assert point.eccentricity == pytest.approx(e, abs=1e-7)


def test_given_speed_and_eccentricity_are_located():
    branch = follow(PAPER, 3500 * RPM, 3900 * RPM)
    model = branch.family.balance.model
    points = list(branch)
    for quantity, wanted in (("value", 3700 * RPM), ("eccentricity", 0.5)):
        before, after = next(
            pair
            for pair in itertools.pairwise(points)
            if getattr(pair[0], quantity) < wanted <= getattr(pair[1], quantity)
        )
        event = lambda point, of=quantity, at=wanted: getattr(point, of) - at  # noqa: E731
        point = locate(branch, before, after, event)
        assert getattr(point, quantity) == pytest.approx(wanted, rel=1e-8)
        assert excess(PAPER, model, point.value, point.eccentricity) == pytest.approx(0, abs=1e-5)


def test_points_are_ordered_and_near():
    branch = follow(override(PAPER, "gravity", True), 3700 * RPM, 4100 * RPM, longest_step=0.03)
    points = list(branch)
    for before, after in itertools.pairwise(points):
        assert before.tangent @ after.tangent > np.cos(branch.options.turning)
        assert branch.corrector.distance(before, after) < 0.031
    assert all(np.linalg.norm(point.tangent) == pytest.approx(1.0) for point in points)


@pytest.mark.parametrize(
    ("path", "start", "end"),
    [
        ("unbalance.disk_2.magnitude", 1e-4, 6e-4),
        ("dampers.damper_1.centering_stiffness", 2.627e6, 5e5),
        ("dampers.damper_1.viscosity", 0.028, 0.05),
        ("dampers.damper_1.clearance", 2.54e-4, 2e-4),
        ("disks.disk_1.polar_inertia", 9.3e-3, 9e-2),
        ("loads.disk_3.force.1", 0.0, -300.0),
    ],
)
def test_any_parameter_can_vary(path, start, end):
    changes = {"gravity": True, "loads": [{"station": "disk_3", "force": [0.0, -1.0]}]}
    machine = override(override_all(PAPER, changes), path, start)
    speed = 3800 * RPM
    balance = HarmonicBalance(machine, Harmonics(3))
    family = ParameterFamily(balance, speed, path)
    first = solve(balance, speed).coefficients.ravel()
    branch = Branch(family, first, start, end)
    points = list(branch)
    assert branch.stop is Stop.RANGE
    assert points[-1].value == end
    direct = solve(HarmonicBalance(override(machine, path, end), Harmonics(3)), speed)
    assert points[-1].x == pytest.approx(direct.coefficients.ravel(), abs=1e-10)


@pytest.mark.parametrize(
    ("path", "start", "end"),
    [
        ("unbalance.disk_2.magnitude", 0.0, 4e-5),
        ("unbalance.disk_2.magnitude", 4e-5, 0.0),
        ("materials.steel.poisson_ratio", 0.485, 0.49999),
        ("materials.steel.poisson_ratio", 0.49999, 0.485),
    ],
)
def test_a_parameter_varies_from_and_to_a_limit_of_its_entry(path, start, end):
    """The machine is not asked for beyond its limits, neither for a slope nor for a point."""
    speed, balance = 3800 * RPM, HarmonicBalance(PAPER, Harmonics(1))
    family = ParameterFamily(balance, speed, path, (min(start, end), max(start, end)))
    first = solve(family.at(start).balance, speed).coefficients.ravel()
    branch = Branch(family, first, start, end)
    points = list(branch)
    assert branch.stop is Stop.RANGE
    assert points[-1].value == end
    direct = solve(family.at(end).balance, speed)
    assert points[-1].x == pytest.approx(direct.coefficients.ravel(), abs=1e-10)


def test_a_branch_up_to_a_resonance_ends():
    """Near an outer diameter of 31.4 mm the shaft, its journal held, is critical at 4 050 rpm."""
    speed, path = 4050 * RPM, "shaft.0.outer_diameter"
    balance = HarmonicBalance(heavier(PAPER, 5.039 / 4.319), Harmonics(1))
    family = ParameterFamily(balance, speed, path, (0.028, 0.0325))
    first = solve(family.at(0.0325).balance, speed).coefficients.ravel()
    branch = Branch(family, first, 0.0325, 0.028, options=ContinuationOptions(points=150))
    points = list(branch)
    assert branch.stop is Stop.CLEARANCE
    assert points[-1].eccentricity > 0.995  # it grows to 1 as the resonance comes nearer
    assert points[-1].value == pytest.approx(0.03143, abs=2e-5)


@pytest.mark.parametrize(
    ("limits", "stop", "most"),
    [
        ({"points": 5}, Stop.POINTS, 6),
        ({"arc": 0.3}, Stop.ARC, 40),
        ({"progress": 10.0}, Stop.PROGRESS, 101),
    ],
    ids=["points", "arc", "progress"],
)
def test_every_limit_ends_a_branch_and_keeps_its_points(limits, stop, most):
    branch = follow(PAPER, 3000 * RPM, 4150 * RPM, harmonics=1, longest_step=0.01, **limits)
    points = list(branch)
    assert branch.stop is stop
    assert 5 <= len(points) <= most


@pytest.mark.parametrize("path", ["dampers.damper_1.viscosity", "dampers.damper_1.clearance"])
def test_slope_by_a_parameter(path):
    balance = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(3))
    family = ParameterFamily(balance, 400.0, path)
    assert_slope(family, {"dampers.damper_1.viscosity": 0.03}.get(path, 2.5e-4))


def test_slope_by_the_speed_is_exact():
    for machine in (override(PAPER, "gravity", True), random_machine(7, dampers=2, gravity=True)):
        assert_slope(SpeedFamily(HarmonicBalance(machine, Harmonics(3))), 380.0)


def test_slope_by_the_load():
    equations = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(3)).at(400.0)
    assert_slope(LoadFamily(equations, 0.0 * equations.force, equations.force), 0.4)


def assert_slope(family, value):
    """The slope by the parameter against a sixth-order difference of the residual."""
    equations = family.at(value)
    rng = np.random.default_rng(0)
    scale = np.tile(equations.balance.clearances, equations.balance.harmonics.rows)
    x = 0.1 * rng.uniform(-1, 1, scale.size) * scale
    step = 1e-3 * value
    difference = sum(
        side * weight * family.at(value + side * m * step).residual(x)
        for m, weight in ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
        for side in (1, -1)
    )
    slope = family.slope(equations, value, x)
    assert np.linalg.norm(difference / step - slope) < 1e-7 * np.linalg.norm(slope)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"first_step": 0.1}, "steps: .* must be positive and rise"),
        ({"shortest_step": 0.0}, "steps: .* must be positive and rise"),
        ({"eccentricity": 1.0}, "eccentricity: 1.0 .* between 0 and 1"),
        ({"points": 0}, "points: 0 .* above 0"),
        ({"arc": -1.0}, "arc: -1.0 .* above 0"),
    ],
)
def test_options_out_of_range_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        ContinuationOptions(**options)
