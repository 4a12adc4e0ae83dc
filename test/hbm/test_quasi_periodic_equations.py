"""The quasi-periodic equations' derivatives against sixth-order differences."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.quasi_periodic import QuasiPeriodicEquations

from .machines import random_machine
from .test_equations import STENCIL


def equations(seed, dampers):
    """Equations of a random machine at random unknowns within the clearance."""
    balance = HarmonicBalance(random_machine(seed, dampers=dampers), Harmonics(1))
    rng = np.random.default_rng(seed)
    harmonics = Harmonics(2)
    size = harmonics.rows * balance.clearances.size
    clearances = np.tile(balance.clearances, harmonics.rows)
    x = np.append(0.12 * rng.uniform(-1, 1, size) * clearances, 530.0)
    phase = rng.uniform(-1, 1, size) / clearances

    def at(speed):
        return QuasiPeriodicEquations(balance, harmonics, speed, phase, 530.0)

    return at, x


@pytest.mark.parametrize("dampers", [1, 2])
@pytest.mark.parametrize("seed", range(3))
def test_jacobian_equals_differences_of_the_residual(seed, dampers):
    at, x = equations(seed, dampers)
    system = at(400.0)
    _, jacobian = system.linearise(x)
    steps = np.append(np.full(x.size - 1, 2e-9), 1e-2)
    for column, step in enumerate(steps):
        move = step * np.eye(x.size)[column]
        difference = sum(
            weight * (system.linearise(x + m * move)[0] - system.linearise(x - m * move)[0])
            for m, weight in STENCIL
        )
        error = np.linalg.norm(difference / step - jacobian[:, column])
        assert error <= 1e-7 * np.linalg.norm(jacobian[:, column])


@pytest.mark.parametrize("dampers", [1, 2])
def test_slope_by_speed_equals_differences(dampers):
    at, x = equations(7, dampers)
    step = 0.01
    difference = sum(
        weight * (at(400.0 + m * step).linearise(x)[0] - at(400.0 - m * step).linearise(x)[0])
        for m, weight in STENCIL
    )
    # the phase condition is scaled by the load, which the speed changes, and holds on the branch
    slope = at(400.0).slope_by_speed(x)[:-1]
    assert np.linalg.norm(difference[:-1] / step - slope) < 1e-7 * np.linalg.norm(slope)
