"""The short film's exact integration against adaptive quadrature of the clipped pressure."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from sfd_hbm_ros.film.short import ShortFilm

from .states import paper_film, random_states


def quadrature_force(film: ShortFilm, x, v, a) -> np.ndarray:
    """Eq. 14 by adaptive quadrature between the sign changes of the pressure of Eq. 13."""
    mu, rho, c = film.viscosity, film.density if film.inertia else 0.0, film.clearance

    def pressure(phi):
        cos, sin = math.cos(phi), math.sin(phi)
        h = c - x[0] * cos - x[1] * sin
        squeeze, pull = v[0] * cos + v[1] * sin, a[0] * cos + a[1] * sin
        return film.length**3 / 12.0 * (12.0 * mu * squeeze / h**3 + rho * pull / h)

    behind = math.atan2(x[1], x[0]) - math.pi
    grid = behind + np.linspace(0.0, 2.0 * np.pi, 2001)
    n = np.stack([np.cos(grid), np.sin(grid)])
    h = c - x @ n
    sign = np.sign(12.0 * mu * (v @ n) / h**3 + rho * (a @ n) / h)
    breaks = [behind, *(behind + math.pi + np.array([-0.3, 0.0, 0.3])), behind + 2.0 * math.pi]
    if film.cavitation:
        changes = np.flatnonzero(sign[:-1] * sign[1:] < 0)
        breaks += [brentq(pressure, grid[i], grid[i + 1], xtol=1e-15) for i in changes]
    breaks.sort()
    total = np.zeros(2)
    for start, end in itertools.pairwise(breaks):
        if film.cavitation and pressure(0.5 * (start + end)) <= 0:
            continue
        for axis, component in enumerate((math.cos, math.sin)):
            total[axis] -= (
                film.radius
                * quad(
                    lambda phi, component=component: pressure(phi) * component(phi),
                    start,
                    end,
                    epsabs=0.0,
                    epsrel=1e-11,
                    limit=200,
                )[0]
            )
    return total


@pytest.mark.filterwarnings("ignore::scipy.integrate.IntegrationWarning")
@pytest.mark.parametrize("inertia", [True, False])
@pytest.mark.parametrize("cavitation", [True, False])
def test_force_equals_adaptive_quadrature(cavitation, inertia):
    film = paper_film(cavitation=cavitation, inertia=inertia)
    x, v, a = random_states(film, 700, seed=1)
    expected = np.array([quadrature_force(film, *state) for state in zip(x, v, a, strict=True)])
    error = np.linalg.norm(film.force(x, v, a) - expected, axis=1)
    assert np.max(error / np.linalg.norm(expected, axis=1)) < 1e-8


def test_states_include_several_arcs_of_positive_pressure():
    """Guards the test above: the random states do reach the rare cases."""
    film = paper_film()
    x, v, a = random_states(film, 700, seed=1)
    phi = np.linspace(0.0, 2.0 * np.pi, 4001)
    n = np.stack([np.cos(phi), np.sin(phi)])
    h = film.clearance - x @ n
    sign = np.sign(12.0 * film.viscosity * (v @ n) + film.density * (a @ n) * h**2)
    arcs = np.count_nonzero(sign[:, :-1] * sign[:, 1:] < 0, axis=1) // 2
    assert set(arcs) >= {1, 2}
    assert np.count_nonzero(arcs >= 2) > 20
