"""Worst errors against the independent truths that the tests hold the solver to.

. scripts/environment.sh; python3 -m benchmarks.accuracy
"""

import time
import warnings

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override
from sfd_hbm_ros.units import RPM
from test.film.states import paper_film, random_states
from test.film.test_short_derivatives import differences, far_from_switching, steps_of
from test.film.test_short_quadrature import quadrature_force
from test.hbm.machines import PAPER, random_machine
from test.hbm.test_circular_orbit import PI_FILM, circular_orbits
from test.hbm.test_uncondensed import uncondensed_residual


def film_force() -> float:
    """Relative error of the force against adaptive quadrature, 2 800 states."""
    worst = 0.0
    for cavitation in (True, False):
        for inertia in (True, False):
            film = paper_film(cavitation=cavitation, inertia=inertia)
            x, v, a = random_states(film, 700, seed=1)
            truth = np.array([quadrature_force(film, *s) for s in zip(x, v, a, strict=True)])
            error = np.linalg.norm(film.force(x, v, a) - truth, axis=1)
            worst = max(worst, float(np.max(error / np.linalg.norm(truth, axis=1))))
    return worst


def film_derivatives() -> float:
    """Relative error of the derivatives against sixth-order differences, 600 states."""
    film = paper_film()
    state = random_states(film, 600, seed=2)
    forces, worst = film.linearise(*state), 0.0
    exact = (forces.by_position, forces.by_velocity, forces.by_acceleration)
    for kind, step in enumerate(steps_of(film, state)):
        columns = [differences(film, state, kind, axis, step) for axis in (0, 1)]
        error = np.linalg.norm(np.stack(columns, axis=-1) - exact[kind], axis=(1, 2))
        scale = np.linalg.norm(exact[kind], axis=(1, 2))
        smooth = far_from_switching(film, state, kind, step)
        worst = max(worst, float(np.max((error / scale)[smooth])))
    return worst


def uncondensed() -> float:
    """Residual of the uncondensed equations over the load, paper's rotor and random machines."""
    worst = 0.0
    for gravity in (False, True):
        balance = HarmonicBalance(override(PAPER, "gravity", gravity), Harmonics(7))
        for rpm in (1500.0, 3000.0, 3880.0, 4500.0, 9000.0):
            worst = max(worst, uncondensed_residual(balance, solve(balance, rpm * RPM)))
    for seed in range(4):
        for dampers in (1, 2):
            machine = random_machine(seed, dampers=dampers, anisotropic=True, gravity=True)
            balance = HarmonicBalance(machine, Harmonics(7))
            worst = max(worst, uncondensed_residual(balance, solve(balance, 250.0 + 60.0 * seed)))
    return worst


def circular_orbit() -> float:
    """Eccentricity against the closed-form circular orbit, 8 random machines at 4 speeds."""
    worst = 0.0
    for seed in range(8):
        machine = random_machine(100 + seed, film=PI_FILM)
        balance = HarmonicBalance(machine, Harmonics(3))
        for w in (150.0, 350.0, 420.0, 700.0):
            e = solve(balance, w).eccentricity_max
            worst = max(
                worst, min(abs(o - e) for o, _ in circular_orbits(machine, balance.model, w))
            )
    return worst


def solve_time() -> float:
    """Seconds of one solve at k = 7 from a solution 5 rpm away, median of a run-up."""
    balance, solution, times = HarmonicBalance(PAPER, Harmonics(7)), None, []
    for rpm in np.arange(2000.0, 6000.0, 5.0):
        started = time.perf_counter()
        solution = solve(balance, rpm * RPM, start=solution)
        times.append(time.perf_counter() - started)
    return float(np.median(times))


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # of quadrature that has reached rounding
    for measure in (film_force, film_derivatives, uncondensed, circular_orbit, solve_time):
        print(f"{measure():9.1e}  {(measure.__doc__ or '').splitlines()[0]}", flush=True)
