"""Without gravity an axisymmetric machine whirls in a circle that one complex equation gives.

On a circle of eccentricity e at the speed W the film's force turns with the journal, and
(U(W) - S(e, W)) z = f with the rotor's dynamic stiffness U from a dense Schur complement of the
full matrices and the film's S in closed form (Gunter, Barrett and Allaire 1977 for the pi film).
"""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import FilmSettings

from .machines import random_machine

PI_FILM = FilmSettings(cavitation=True, inertia=False)
FULL_FILM = FilmSettings(cavitation=False, inertia=True)
CAVITATED_WITH_INERTIA = FilmSettings(cavitation=True, inertia=True)


def secant(damper, e, w):
    """Force of the film over the displacement on a circular orbit, radial + i tangential."""
    radius, c = 0.5 * damper.diameter, damper.clearance
    viscous = damper.viscosity * radius * damper.length**3 / c**3
    inertial = damper.density * radius * damper.length**3 / (12.0 * c)
    s = np.sqrt(1.0 - e * e)
    if damper.film == PI_FILM:
        return -viscous * w * (2.0 * e / s**4 + 0.5j * np.pi / s**3)
    if damper.film == FULL_FILM:
        inertia = inertial * w**2 * 2.0 * np.pi * (1.0 / s - 1.0) / e**2
        return inertia - 1j * viscous * w * np.pi / s**3

    def pressure(theta):
        h = 1.0 - e * np.cos(theta)
        return viscous * w * np.sin(theta) / h**3 - inertial * w**2 * np.cos(theta) / h

    start = brentq(pressure, -0.5 * np.pi, 0.5 * np.pi, xtol=1e-15)
    end = brentq(pressure, 0.5 * np.pi, 1.5 * np.pi, xtol=1e-15)

    def moment(part):
        scale = 1e-13 * viscous * w
        return quad(lambda t: pressure(t) * part(t), start, end, epsabs=scale, epsrel=1e-12)[0]

    radial, tangential = moment(np.cos), moment(np.sin)
    return -radial - 1j * tangential


def forward_whirl(model, w):
    """Stiffness of the journal's forward whirl and the force that drives it, both complex."""
    stiffness = model.K - w**2 * model.M + 1j * w * (model.C + w * model.G)
    journal = model.journals[0]
    shaft = np.setdiff1d(np.arange(len(stiffness)), journal)
    force = w**2 * model.unbalance
    eliminated = np.linalg.solve(
        stiffness[np.ix_(shaft, shaft)],
        np.column_stack([stiffness[np.ix_(shaft, journal)], force[shaft]]),
    )
    u = stiffness[np.ix_(journal, journal)] - stiffness[np.ix_(journal, shaft)] @ eliminated[:, :2]
    f = force[journal] - stiffness[np.ix_(journal, shaft)] @ eliminated[:, 2]
    # (x, y) = z (1, -i), so that the stiffness is one complex number
    return u[0, 0] - 1j * u[0, 1], f[0]


def excess(machine, model, w, e):
    """Force that a circle of eccentricity e needs, beyond the one that drives it."""
    [damper] = machine.dampers
    stiffness, drive = forward_whirl(model, w)
    return abs(stiffness - secant(damper, e, w)) * e * damper.clearance - abs(drive)


def circular_orbits(machine, model, w, beside_folds=False):
    """All eccentricities and complex positions of circular orbits, by a scan and bisection.

    Two that nearly coincide, as beside a fold, are only seen if they are asked for.
    """
    [damper] = machine.dampers
    stiffness, drive = forward_whirl(model, w)

    def imbalance(e):
        return abs(stiffness - secant(damper, e, w)) * e * damper.clearance - abs(drive)

    grid = np.concatenate([np.geomspace(1e-6, 0.05, 20), np.linspace(0.06, 0.999, 200)])
    values = np.array([imbalance(e) for e in grid])
    # two roots between neighbours of the grid, as beside a fold, lie about an extremum
    sizes = np.abs(values)
    for i in np.flatnonzero((sizes[1:-1] < sizes[:-2]) & (sizes[1:-1] < sizes[2:])) + 1:
        if beside_folds and values[i - 1] * values[i] > 0.0 and values[i] * values[i + 1] > 0.0:
            sign, bounds = np.sign(values[i]), (grid[i - 1], grid[i + 1])
            nearest = minimize_scalar(lambda e, s=sign: s * imbalance(e), bounds=bounds)
            at = int(np.searchsorted(grid, nearest.x))
            grid = np.insert(grid, at, nearest.x)
            values = np.insert(values, at, sign * nearest.fun)
            break
    roots = [
        brentq(imbalance, grid[i], grid[i + 1], xtol=1e-15, rtol=1e-14)
        for i in np.flatnonzero(values[:-1] * values[1:] < 0)
    ]
    return [(e, drive / (stiffness - secant(damper, e, w))) for e in roots]


@pytest.mark.parametrize("film", [PI_FILM, FULL_FILM, CAVITATED_WITH_INERTIA])
@pytest.mark.parametrize("seed", range(8))
def test_equals_the_closed_form(seed, film):
    machine = random_machine(100 + seed, film=film)
    balance = HarmonicBalance(machine, Harmonics(3))
    for w in (150.0, 350.0, 420.0, 700.0):
        solution = solve(balance, w)
        assert solution.converged, solution.message
        motion = solution.journals["damper_1"]
        orbits = circular_orbits(machine, balance.model, w)
        eccentricity, z = min(orbits, key=lambda orbit: abs(orbit[0] - motion.eccentricity_max))
        assert motion.eccentricity_max == pytest.approx(eccentricity, abs=1e-8)
        # x = Re(z exp(i W t)), y turns a quarter behind
        expected = np.zeros((7, 2))
        expected[1:3] = [[z.real, z.imag], [-z.imag, z.real]]
        assert motion.coefficients / motion.clearance == pytest.approx(
            expected / motion.clearance, abs=1e-8
        )
