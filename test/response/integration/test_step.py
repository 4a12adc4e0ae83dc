"""The equations of one step, put back where they come from."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.response.integration.collocation import Radau
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.step import Step

from ...hbm.machines import random_machine

W = 300.0
RADAU = Radau(4)
STAGES = Ramp(W, 50.0, 9).stages(0.0, 0.125, RADAU.nodes)


@pytest.fixture(scope="module", params=[1, 2], ids=["one damper", "two dampers"])
def step(request):
    balance = HarmonicBalance(
        random_machine(710, dampers=request.param, gravity=True), Harmonics(3)
    )
    solution = solve(balance, W)
    assert solution.converged
    integrator = Integrator(balance, W)
    state = integrator.start(solution)
    rotor = integrator.rotor
    step = Step(rotor, balance.films, RADAU, STAGES, state.displacement, state.velocity)
    angle = 2.0 * np.pi * 0.125 * RADAU.nodes
    x = W**2 * (solution.harmonics.basis_at(angle, 2) @ solution.coefficients).ravel()
    return balance, rotor, step, x


def test_derivative_is_that_of_the_imbalance(step):
    _, _, equations, x = step
    _, jacobian = equations.linearise(x)
    change = 1e-5 * np.abs(x).max()
    for i, unit in enumerate(np.eye(x.size)):
        above, below = (equations.linearise(x + sign * change * unit)[0] for sign in (1, -1))
        assert jacobian[:, i] == pytest.approx((above - below) / (2.0 * change), abs=1e-6)


def test_motion_obeys_the_uncondensed_equations(step):
    """At the end of the step M q'' + (C + W G) q' + K q = f + F gives the journals' q''."""
    balance, rotor, equations, x = step
    for _ in range(20):
        residual, jacobian = equations.linearise(x)
        x = x - np.linalg.solve(jacobian, residual)
    end = equations.motion(x, RADAU.nodes)
    journals = rotor.journals.ravel()
    assert end.positions[-1] == pytest.approx(end.q[journals], rel=1e-9)
    assert end.accelerations.ravel() == pytest.approx(x, rel=1e-9)
    force = rotor.static_force + (STAGES.turning[-1] * rotor.unbalance).real
    force -= (rotor.C + STAGES.speed[-1] * rotor.G) @ end.v + rotor.K @ end.q
    for damper, (at, film) in enumerate(zip(rotor.journals, balance.films, strict=True)):
        own = slice(2 * damper, 2 * damper + 2)
        force[at] += film.force(
            end.q[at][np.newaxis], end.v[at][np.newaxis], end.accelerations[-1:, own]
        )[0]
    acceleration = np.linalg.solve(rotor.M, force)
    assert acceleration[journals] == pytest.approx(end.accelerations[-1], rel=1e-6)


def test_largest_step_stays_within_the_clearance(step):
    _, _, equations, x = step
    assert equations.inside(x)
    far = np.full(x.size, 1e6)
    assert not equations.inside(x + far)
    part = equations.largest_step(x, far)
    assert equations.inside(x + part * far)
    assert equations.largest_step(x, 1e-9 * far) == 1.0
