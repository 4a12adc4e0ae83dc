"""The equations' Jacobian, their convergence with the harmonics, and their step control."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve

from .machines import random_machine

STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))


@pytest.mark.parametrize("dampers", [1, 2])
@pytest.mark.parametrize("seed", range(3))
def test_jacobian_equals_differences_of_the_residual(seed, dampers):
    machine = random_machine(200 + seed, dampers=dampers, anisotropic=True, gravity=True)
    equations = HarmonicBalance(machine, Harmonics(3)).at(400.0)
    rng = np.random.default_rng(seed)
    size = equations.force.size
    x = 0.12 * rng.uniform(-1, 1, size) * np.tile(equations.balance.clearances, 7)
    residual, jacobian = equations.linearise(x)
    assert np.array_equal(residual, equations.residual(x))
    step = 2e-9
    for column in range(size):
        move = step * np.eye(size)[column]
        difference = sum(
            weight * (equations.residual(x + m * move) - equations.residual(x - m * move))
            for m, weight in STENCIL
        )
        assert np.linalg.norm(difference / step - jacobian[:, column]) <= 1e-7 * np.linalg.norm(
            jacobian[:, column]
        )


@pytest.mark.parametrize("seed", [303, 306, 310])
def test_error_falls_geometrically_with_the_number_of_harmonics(seed):
    machine = random_machine(seed, gravity=True)
    reference = solve(HarmonicBalance(machine, Harmonics(31)), 380.0).journals["damper_1"]
    assert reference.eccentricity_max > 0.25
    errors = []
    highest = (1, 3, 5, 7, 9, 11)
    for k in highest:
        solution = solve(HarmonicBalance(machine, Harmonics(k, samples=512)), 380.0)
        difference = solution.journals["damper_1"].orbit() - reference.orbit()
        errors.append(np.abs(difference).max() / reference.clearance)
    assert np.all(np.diff(errors) < 0)
    # a straight line over k on a logarithmic scale: at least a factor of 2 for each harmonic
    slope, _ = np.polyfit(highest, np.log(errors), 1)
    assert np.exp(slope) < 0.5
    assert errors[-1] < 1e-6


def test_no_step_leaves_the_clearance():
    machine = random_machine(400, dampers=2)
    equations = HarmonicBalance(machine, Harmonics(5)).at(300.0)
    c = equations.balance.clearances
    rng = np.random.default_rng(0)
    basis = equations.balance.harmonics.bases[0]

    def eccentricity(x):
        position = (basis @ x.reshape(-1, 4) / c).reshape(-1, 2, 2)
        return np.linalg.norm(position, axis=-1).max()

    for _ in range(200):
        x = (rng.normal(size=(11, 4)) * c).ravel()
        x *= rng.uniform(0.0, 0.999) / eccentricity(x)
        step = (rng.normal(size=(11, 4)) * c).ravel() * 10.0 ** rng.uniform(-3, 6)
        part = equations.largest_step(x, step)
        assert 0.0 < part <= 1.0
        assert eccentricity(x + part * step) < 1.0


def test_more_samples_change_nothing():
    machine = random_machine(306, gravity=True)
    few = solve(HarmonicBalance(machine, Harmonics(7)), 380.0)
    many = solve(HarmonicBalance(machine, Harmonics(7, samples=1024)), 380.0)
    difference = np.abs(few.coefficients - many.coefficients).max()
    assert difference < 1e-8 * few.journals["damper_1"].clearance


@pytest.mark.parametrize(
    ("arguments", "words"),
    [((0,), "harmonics: 0 .* at least 1"), ((7, 14), "samples: 14 .* at least 15")],
)
def test_harmonics_out_of_range_are_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        Harmonics(*arguments)
