"""Floquet multipliers against references that neither reduce the rotor nor step in time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sfd_hbm_ros.hbm import (
    HarmonicBalance,
    Harmonics,
    Instability,
    Outcome,
    floquet,
    solve,
    stability,
)
from sfd_hbm_ros.hbm.floquet import REACH
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.machine import override, override_all
from sfd_hbm_ros.rotor import reduce_model

from .machines import PAPER, UNBEARABLE, random_machine
from .test_circular_orbit import circular_orbits


def rotating_frame_exponents(balance, solution):
    """Exponents of a circular orbit of the whole rotor: in the rotating frame it stands still.

    With q = R(t) p the equations M (p'' + 2 W J p' - W^2 p) + C (p' + W J p) + K p = 0 have
    constant coefficients, and R is the unit matrix after one revolution.
    """
    model, w = balance.model, solution.speed
    mass, damping, stiffness = model.M.copy(), model.C + w * model.G, model.K.copy()
    motion = solution.journals["damper_1"]
    basis = [solution.harmonics.basis_at(np.zeros(1), order) for order in (0, 1, 2)]
    film = balance.films[0].linearise(
        *(w**order * (basis[order] @ motion.coefficients) for order in (0, 1, 2))
    )
    corner = np.ix_(model.journals[0], model.journals[0])
    mass[corner] -= film.by_acceleration[0]
    damping[corner] -= film.by_velocity[0]
    stiffness[corner] -= film.by_position[0]
    n = model.size
    turn = np.kron(np.eye(n // 2), [[0.0, -1.0], [1.0, 0.0]])
    rotating_damping = damping + 2.0 * w * mass @ turn
    rotating_stiffness = stiffness + w * damping @ turn - w * w * mass
    rates = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [-np.linalg.solve(mass, np.hstack([rotating_stiffness, rotating_damping]))],
        ]
    )
    return np.linalg.eigvals(rates)


def orbits(machine, w):
    """Every circular orbit of a machine at a speed, as a solution."""
    balance = HarmonicBalance(machine, Harmonics(3))
    for _, z in circular_orbits(machine, balance.model, w):
        start = np.zeros((7, 2))
        start[1:3] = [[z.real, z.imag], [-z.imag, z.real]]
        result = newton(balance.at(w), start.ravel())
        assert result.outcome is Outcome.CONVERGED
        yield balance, solution_at(balance, w, result.x)


def assert_agreement(found, exponents, w):
    """Sign over all exponents, and each slow multiplier of the reference among those found."""
    assert found.stable == (exponents.real.max() < 1e-6 * w)  # undamped modes round to zero
    for multiplier in np.exp(2.0 * np.pi / w * exponents[np.abs(exponents) < 3.0 * w]):
        nearest = np.abs(found.multipliers - multiplier).min()
        assert nearest < 0.01 * max(abs(multiplier), 0.05)


@pytest.mark.parametrize("seed", range(500, 512))
def test_random_circular_orbits(seed):
    for w in (200.0, 350.0, 500.0):
        for balance, solution in orbits(random_machine(seed), w):
            exponents = rotating_frame_exponents(balance, solution)
            assert_agreement(stability(balance, solution), exponents, w)


@pytest.mark.parametrize("rpm", [3990.0, 4040.0, 4120.0])
def test_middle_orbit_of_the_paper_rotor_is_unstable(rpm):
    machine = override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4)
    w = rpm * np.pi / 30.0
    judged = []
    for balance, solution in orbits(machine, w):
        exponents = rotating_frame_exponents(balance, solution)
        judged.append(stability(balance, solution))
        assert_agreement(judged[-1], exponents, w)
    assert [one.instability for one in judged] == [None, Instability.FOLD, None]


def integrated_multipliers(balance, solution):
    """Multipliers from the variational equations of the reduced rotor, integrated in time."""
    w = solution.speed
    rotor = reduce_model(balance.model, REACH * w)
    [motion], [journal], [film] = solution.journals.values(), rotor.journals, balance.films
    n, corner = rotor.size, np.ix_(journal, journal)

    def rate(t, y):
        basis = [solution.harmonics.basis_at(np.array([w * t]), order) for order in (0, 1, 2)]
        forces = film.linearise(
            *(w**order * (basis[order] @ motion.coefficients) for order in (0, 1, 2))
        )
        mass, damping, stiffness = rotor.M.copy(), rotor.C + w * rotor.G, rotor.K.copy()
        mass[corner] -= forces.by_acceleration[0]
        damping[corner] -= forces.by_velocity[0]
        stiffness[corner] -= forces.by_position[0]
        q, v = np.vsplit(y.reshape(2 * n, 2 * n), 2)
        return np.vstack([v, -np.linalg.solve(mass, damping @ v + stiffness @ q)]).ravel()

    revolution = (0.0, 2.0 * np.pi / w)
    unit = np.diag(np.repeat([1.0, w], n))  # displacements and velocities of like size
    result = solve_ivp(rate, revolution, unit.ravel(), method="DOP853", rtol=1e-7, atol=1e-7)
    monodromy = result.y[:, -1].reshape(2 * n, 2 * n) @ np.linalg.inv(unit)
    multipliers = np.linalg.eigvals(monodromy)
    return multipliers[np.argsort(-np.abs(multipliers))]


@pytest.mark.parametrize(("seed", "w"), [(302, 380.0), (307, 380.0), (311, 250.0)])
def test_orbits_under_gravity(seed, w):
    machine = random_machine(seed, gravity=True)
    balance = HarmonicBalance(machine, Harmonics(9))
    solution = solve(balance, w)
    assert solution.journals["damper_1"].eccentricity_max > 0.5
    found, reference = stability(balance, solution), integrated_multipliers(balance, solution)
    assert found.stable == (abs(reference[0]) < 1.0)
    assert abs(found.multipliers[0]) == pytest.approx(abs(reference[0]), rel=0.01)
    for multiplier in found.multipliers[np.abs(found.multipliers) > 0.05]:
        assert np.abs(reference - multiplier).min() < 0.01 * abs(multiplier)


def test_solution_that_did_not_converge_is_refused():
    balance = HarmonicBalance(override_all(PAPER, UNBEARABLE), Harmonics(3))
    solution = solve(balance, 400.0)
    with pytest.raises(ValueError, match="no solution at 400"):
        stability(balance, solution)


@pytest.mark.parametrize("rpm", [4150.0, 4161.0, 4161.5])
def test_stiff_film_in_the_fixed_frame(rpm, monkeypatch):
    """Up to an eccentricity of 0.99 on a circle, whose multipliers the rotating frame gives."""
    machine = override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4)
    w = rpm * np.pi / 30.0
    *_, (balance, solution) = orbits(machine, w)
    assert solution.eccentricity_max > 0.95
    exponents = rotating_frame_exponents(balance, solution)
    slow = np.exp(2.0 * np.pi / w * exponents[np.abs(exponents) < 3.0 * w])
    monkeypatch.setattr(floquet, "is_axisymmetric", lambda rotor: False)
    found = stability(balance, solution)
    assert abs(found.multipliers[0]) == pytest.approx(np.abs(slow).max(), abs=2e-5)


def test_overloaded_journal_is_judged():
    """At an eccentricity beyond 0.995 as well, and without a false alarm at 0.966."""
    load = [{"station": "disk_3", "force": [0.0, -8.0 * 137.45]}]
    machine = override_all(PAPER, {"gravity": True, "loads": load})
    balance = HarmonicBalance(machine, Harmonics(9))
    for rpm in (1500.0, 2412.0):
        solution = solve(balance, rpm * np.pi / 30.0)
        assert solution.eccentricity_max > 0.96
        assert stability(balance, solution).stable
