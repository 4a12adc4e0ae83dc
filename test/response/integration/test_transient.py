"""Motions in time against harmonic balance, closed forms and another integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import FilmSettings, override, override_all
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.integrator import Integrator, State
from sfd_hbm_ros.response.integration.options import IntegrationOptions
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import run, simulate

from ...hbm.machines import PAPER, UNBEARABLE, random_machine

RPM = np.pi / 30.0
TIGHT = IntegrationOptions(tolerance=1e-13)


def linear_machine(seed, unbalance):
    """A random machine on a full film, of which small motions are linear."""
    film = FilmSettings(cavitation=False, inertia=True)
    paths = [f"unbalance.disk_{i}.magnitude" for i in (1, 2)]
    return override_all(random_machine(seed, film=film), dict.fromkeys(paths, unbalance))


def small_motion(integrator):
    """Mass and damping of the reduced rotor with the film's coefficients about the centre."""
    rotor, [film] = integrator.rotor, integrator.balance.films
    mass, damping = rotor.M.copy(), rotor.C.copy()
    corner = np.ix_(rotor.journals[0], rotor.journals[0])
    mass[corner] += film.centred_inertia * np.eye(2)
    damping[corner] += film.centred_damping * np.eye(2)
    return mass, damping


def displaced(integrator, q, v):
    """A state of which nothing is known about the accelerations to come."""
    options = integrator.options
    return State(q, v, np.zeros((options.steps, options.stages, integrator.rotor.journals.size)))


def test_settles_in_the_harmonic_balance_solution():
    """Under gravity, begun with the response at another speed."""
    balance = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(9))
    w = 3800.0 * RPM
    integrator = Integrator(balance, w)
    transient = run(integrator, Ramp(w, 0.0, 250), integrator.start(solve(balance, 0.99 * w)))
    motion = solve(balance, w).journals["damper_1"]
    error = np.abs(transient.orbit["damper_1"] - motion.orbit(128)).max() / motion.clearance
    assert error < 1e-4


@pytest.mark.parametrize("stages", [2, 3])
def test_order_of_convergence(stages):
    """2s - 1, with the full film, whose force has all derivatives."""
    changes = {"gravity": True, "dampers.damper_1.film.cavitation": False}
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(9))
    w = 3900.0 * RPM
    solution = solve(balance, w)

    def journal_after_a_revolution(steps, stages):
        options = IntegrationOptions(steps, stages, tolerance=1e-12, resolution=np.inf)
        integrator = Integrator(balance, w, options)
        transient = run(integrator, Ramp(w, 100.0, 1), integrator.start(solution))
        return transient.state.displacement[integrator.rotor.journals[0]]

    exact = journal_after_a_revolution(16, 12)
    steps = np.array([8, 16, 32, 64])
    errors = [np.abs(journal_after_a_revolution(n, stages) - exact).max() for n in steps]
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(2 * stages - 1, abs=0.3)


def test_free_motion_decays_as_its_mode():
    """Small motion about the centre, by the complex eigenvalue of the rotor on its film."""
    balance, w = HarmonicBalance(linear_machine(700, 0.0), Harmonics(1)), 200.0
    integrator = Integrator(balance, w, TIGHT)
    rotor = integrator.rotor
    mass, damping = small_motion(integrator)
    right = np.hstack([rotor.K, damping + w * rotor.G])
    rates = np.eye(2 * rotor.size, k=rotor.size)
    rates[rotor.size :] = -np.linalg.solve(mass, right)
    exponents, modes = np.linalg.eig(rates)
    lowest = np.argmin(np.where(exponents.imag > 0.0, np.abs(exponents), np.inf))
    exponent, mode = exponents[lowest], modes[:, lowest]
    mode *= 1e-4 * balance.films[0].clearance / np.abs(mode[rotor.journals[0]]).max()
    start = displaced(integrator, *np.split(mode.real, 2))
    end = run(integrator, Ramp(w, 0.0, 1), start).state
    after = np.exp(exponent * 2.0 * np.pi / w)
    assert 0.05 < abs(after) < 0.9
    for found, expected in zip(
        (end.displacement, end.velocity), np.split((after * mode).real, 2), strict=True
    ):
        assert found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


def test_unbalance_of_an_accelerating_rotor():
    """Small motion from rest, of forces U [W^2 (cos, sin) + dW/dt (sin, -cos)]."""
    balance = HarmonicBalance(linear_machine(701, 1e-7), Harmonics(1))
    w, acceleration = 100.0, 1000.0  # dW/dt is a tenth of W^2
    integrator, ramp = Integrator(balance, 2.0 * w, TIGHT), Ramp(w, acceleration, 2)
    rotor = integrator.rotor
    mass, damping = small_motion(integrator)
    size, phase = np.abs(rotor.unbalance[::2]), np.angle(rotor.unbalance[::2])

    def rate(t, y):
        q, v = np.split(y, 2)
        speed, angle = w + acceleration * t, w * t + 0.5 * acceleration * t**2 + phase
        force = np.empty(rotor.size)
        force[::2] = size * (speed**2 * np.cos(angle) + acceleration * np.sin(angle))
        force[1::2] = size * (speed**2 * np.sin(angle) - acceleration * np.cos(angle))
        force -= rotor.K @ q + (damping + speed * rotor.G) @ v
        return np.concatenate([v, np.linalg.solve(mass, force)])

    nothing = np.zeros(rotor.size)
    duration = float(ramp.time(np.array([2.0]))[0])
    reference = solve_ivp(
        rate, (0.0, duration), np.zeros(2 * rotor.size), method="DOP853", rtol=1e-9, atol=1e-18
    )
    expected = reference.y[: rotor.size, -1]
    found = run(integrator, ramp, displaced(integrator, nothing, nothing)).state.displacement
    assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_halved_steps_agree():
    """A step too long for a sudden blow on the journal is halved until it is resolved."""
    balance = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(7))
    w = 3900.0 * RPM
    ends = []
    for options in (IntegrationOptions(), IntegrationOptions(steps=64, stages=6)):
        integrator = Integrator(balance, w, options)
        state = integrator.start(solve(balance, w))
        velocity = state.velocity.copy()
        velocity[integrator.rotor.journals[0]] += [0.5, -0.5]
        blown = State(state.displacement, velocity, state.expected)
        ends.append(run(integrator, Ramp(w, 0.0, 1), blown))
    one, other = (end.orbit["damper_1"] / PAPER.dampers[0].clearance for end in ends)
    assert one == pytest.approx(other, abs=1e-4)


def test_journal_that_cannot_be_stopped_is_named():
    balance, w = HarmonicBalance(PAPER, Harmonics(1)), 3900.0 * RPM
    integrator = Integrator(balance, w)
    velocity = np.zeros(integrator.rotor.size)
    velocity[integrator.rotor.journals[0]] = 1e6, 0.0
    with pytest.raises(NoSolutionError, match="a journal closed on its clearance, at 3900 rpm"):
        run(integrator, Ramp(w, 0.0, 1), displaced(integrator, np.zeros_like(velocity), velocity))


def test_no_start_is_named():
    balance = HarmonicBalance(override_all(PAPER, UNBEARABLE), Harmonics(3))
    with pytest.raises(NoSolutionError, match="no solution to start from at 3000 rpm: the load"):
        simulate(balance, 3000.0 * RPM, 3100.0 * RPM, 100.0)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"steps": 3}, "steps: 3 is not allowed, it must divide 128"),
        ({"stages": 1}, "stages: 1 is not allowed"),
        ({"tolerance": 0.0}, "tolerance: 0.0 is not allowed"),
        ({"resolution": -1.0}, "resolution: -1.0 is not allowed, it must be positive"),
    ],
)
def test_bad_settings_are_refused(settings, sentence):
    balance = HarmonicBalance(PAPER, Harmonics(1))
    with pytest.raises(ValueError, match=sentence):
        Integrator(balance, 400.0, IntegrationOptions(**settings))
