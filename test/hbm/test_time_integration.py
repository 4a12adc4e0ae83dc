"""Under gravity and side loads, against the steady state of a time integration from rest."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import FilmSettings

from .machines import random_machine


def craig_bampton(model, modes):
    """Columns of static constraint modes and of the lowest modes with the journals held."""
    n, held = len(model.M), model.journals.ravel()
    free = np.setdiff1d(np.arange(n), held)
    inner = np.ix_(free, free)
    basis = np.zeros((n, len(held) + modes))
    basis[held, np.arange(len(held))] = 1.0
    basis[free, : len(held)] = -np.linalg.solve(model.K[inner], model.K[np.ix_(free, held)])
    basis[free, len(held) :] = eigh(
        model.K[inner], model.M[inner], subset_by_index=(0, modes - 1)
    )[1]
    return basis


class FirstOrder:
    """A machine's film and its rotor in reduced coordinates as y' = f(t, y), y = (q, q')."""

    def __init__(self, balance, w, modes=6):
        model, [self.film] = balance.model, balance.films
        basis = craig_bampton(model, modes)
        self.M, self.K, self.damping = (
            basis.T @ matrix @ basis for matrix in (model.M, model.K, model.C + w * model.G)
        )
        self.static = basis.T @ model.static_force
        self.unbalance = w**2 * basis.T @ model.unbalance
        self.w, self.size = w, basis.shape[1]
        self.acceleration = np.zeros(self.size)  # where the iteration of the next one starts
        self.journal = np.arange(2)  # the first two coordinates are the journal's

    def rate(self, t, y):
        q, v = y[: self.size], y[self.size :]
        turning = (self.unbalance * np.exp(1j * self.w * t)).real
        rhs = self.static + turning - self.damping @ v - self.K @ q
        journal = self.journal
        a = self.acceleration
        # the film's force depends on the acceleration: Newton's method on M a = rhs + film(a)
        for _ in range(20):
            film = self.film.linearise(q[journal][None], v[journal][None], a[journal][None])
            imbalance = self.M @ a - rhs
            imbalance[journal] -= film.force[0]
            mass = self.M.copy()
            mass[np.ix_(journal, journal)] -= film.by_acceleration[0]
            change = np.linalg.solve(mass, imbalance)
            a = a - change
            if np.linalg.norm(change) <= 1e-8 * np.linalg.norm(a):
                break
        self.acceleration = a
        return np.concatenate([v, a])

    def jacobian(self, t, y):
        a = self.rate(t, y)[self.size :]
        q, v = y[: self.size], y[self.size :]
        journal, corner = self.journal, np.ix_(self.journal, self.journal)
        film = self.film.linearise(q[journal][None], v[journal][None], a[journal][None])
        mass, damping, stiffness = self.M.copy(), self.damping.copy(), self.K.copy()
        mass[corner] -= film.by_acceleration[0]
        damping[corner] -= film.by_velocity[0]
        stiffness[corner] -= film.by_position[0]
        lower = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
        upper = np.hstack([np.zeros((self.size, self.size)), np.eye(self.size)])
        return np.vstack([upper, lower])


@pytest.mark.parametrize(
    ("seed", "w", "film"),
    [
        (306, 300.0, FilmSettings(cavitation=True, inertia=True)),
        (307, 400.0, FilmSettings(cavitation=True, inertia=False)),
    ],
)
def test_equals_the_steady_state(seed, w, film):
    machine = random_machine(seed, film=film, gravity=True, elements=4)
    balance = HarmonicBalance(machine, Harmonics(9))
    motion = solve(balance, w).journals["damper_1"]
    assert motion.eccentricity_max > 0.2
    system = FirstOrder(balance, w)
    revolution = 2.0 * np.pi / w
    revolutions = 7  # the slowest transients of these machines are below 1e-4 by then
    last = revolution * (revolutions - 1 + np.arange(64) / 64)
    result = solve_ivp(
        system.rate,
        (0.0, revolutions * revolution),
        np.zeros(2 * system.size),
        method="LSODA",
        jac=system.jacobian,
        t_eval=last,
        rtol=1e-5,
        atol=1e-5 * motion.clearance,
    )
    assert result.success
    error = np.abs(result.y[system.journal].T - motion.orbit(64)).max() / motion.clearance
    assert error < 1e-3
