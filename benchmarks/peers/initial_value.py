"""Steady state of the condensed rotor, beside SciPy's `solve_ivp`."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.peers.problem import NEWTON, PAPER, SPEED, Row, median_seconds, seconds
from sfd_hbm_ros.film import FilmModel
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.rotor import RotorModel, reduce_model

Array = NDArray[np.float64]

REACH = 50.0  # multiple of the speed up to which the rotor's modes are kept
REVOLUTIONS = 100  # after which 2e-7 of the first disturbance is left
SAMPLES = 128  # of the last revolution


class Motion:
    """The reduced rotor with one film as a system of first order, of (q, q') with q of (N,)."""

    def __init__(self, model: RotorModel, film: FilmModel, speed: float) -> None:
        self.model, self.film, self.speed = model, film, speed
        self.inverse = np.linalg.inv(model.M)
        self.damping = model.C + speed * model.G
        self.journal = model.journals[0]

    def rates(self, time: float, state: Array) -> Array:
        """Derivative of the state."""
        model, j = self.model, self.journal
        q, v = np.split(state, 2)
        push = model.unbalance * np.exp(1j * self.speed * time) * self.speed**2
        free = self.inverse @ (push.real + model.static_force - self.damping @ v - model.K @ q)
        force = self._film_force(q[j], v[j], free[j])
        return np.concatenate([v, free + self.inverse[:, j] @ force])

    def _film_force(self, position: Array, velocity: Array, free: Array) -> Array:
        """The film's force; it depends on the acceleration that it gives, hence iterations."""
        mobility = self.inverse[np.ix_(self.journal, self.journal)]
        acceleration = free
        for _ in range(20):
            film = self.film.linearise(
                *(one[np.newaxis] for one in (position, velocity, acceleration))
            )
            excess = acceleration - free - mobility @ film.force[0]
            step = np.linalg.solve(np.eye(2) - mobility @ film.by_acceleration[0], excess)
            acceleration = acceleration - step
            if np.abs(step).max() <= 1e-12 * np.abs(acceleration).max():
                break
        force: Array = film.force[0]
        return force


def rows() -> Iterator[Row]:
    """The one row."""
    balance = HarmonicBalance(PAPER, Harmonics(7, SAMPLES))
    clearance = PAPER.dampers[0].clearance
    reduced = reduce_model(balance.model, REACH * SPEED)
    motion = Motion(reduced, balance.films[0], SPEED)
    period = 2.0 * np.pi / SPEED
    last = period * (REVOLUTIONS - 1 + np.arange(SAMPLES) / SAMPLES)
    found: list[Array] = []

    def integrate() -> None:
        result = solve_ivp(
            motion.rates,
            (0.0, REVOLUTIONS * period),
            np.zeros(2 * reduced.size),
            method="DOP853",
            t_eval=last,
            rtol=1e-6,
            atol=1e-6 * clearance * np.repeat([1.0, SPEED], reduced.size),
        )
        found.append(result.y[motion.journal].T)

    theirs = seconds(integrate)
    solution = solve(balance, SPEED, options=NEWTON)
    orbit = balance.harmonics.bases[0] @ solution.coefficients
    worst = float(np.linalg.norm(found[0] - orbit, axis=1).max()) / clearance
    yield Row(
        f"steady state at one speed from nothing (SciPy: {REVOLUTIONS} revolutions of "
        f"{reduced.size} coordinates)",
        "SciPy, solve_ivp",
        median_seconds(lambda: solve(balance, SPEED, options=NEWTON), repeats=5),
        theirs,
        f"orbits to {worst:.0e} of the clearance",
    )
