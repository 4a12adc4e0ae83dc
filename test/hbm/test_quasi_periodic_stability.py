"""Floquet multipliers of quasi-periodic responses against theory and an integration in time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sfd_hbm_ros.hbm.quasi_periodic_response import quasi_periodic_stability
from sfd_hbm_ros.rotor import reduce_model

from .test_quasi_periodic import BALANCE, RPM, branch, least_damped


def test_stability_near_the_onset_is_that_of_the_normal_form():
    """Where the circle's disturbances grow as exp(s t), the new response's decay twice as fast.

    Kuznetsov 2004, Elements of Applied Bifurcation Theory, sec. 3.4: for r' = s r - b r^3 the
    derivative at the limit cycle r^2 = s / b is -2 s.
    """
    _, responses = branch()
    for response in [one for one in responses if 0.12 < one.amplitude < 0.2]:
        found = quasi_periodic_stability(BALANCE, response)
        growth = least_damped(response.speed).real
        period = 2.0 * np.pi / response.frequency
        assert found.stable
        assert 1.0 - abs(found.multipliers[0]) == pytest.approx(2.0 * growth * period, rel=0.15)


def integrated_multipliers(response):
    """Multipliers by integration in time of the disturbances of the reduced rotor.

    They are taken in the fixed frame over a period of the frequency in the turning one, and then
    turned back.
    """
    w, period = response.speed, 2.0 * np.pi / response.frequency
    rotor = reduce_model(BALANCE.model, 30.0 * w)
    [film], [journal], n = BALANCE.films, rotor.journals, rotor.size
    corner = np.ix_(journal, journal)
    k = np.arange(-response.harmonics.highest, response.harmonics.highest + 1)
    s, whirl = w + k * response.frequency, response.whirl("damper_1")

    def rate(t, y):
        z = [np.sum(whirl * (1j * s) ** order * np.exp(1j * s * t)) for order in (0, 1, 2)]
        forces = film.linearise(*(np.array([[one.real, one.imag]]) for one in z))
        mass, damping, stiffness = rotor.M.copy(), rotor.C + w * rotor.G, rotor.K.copy()
        mass[corner] -= forces.by_acceleration[0]
        damping[corner] -= forces.by_velocity[0]
        stiffness[corner] -= forces.by_position[0]
        q, v = np.vsplit(y.reshape(2 * n, 2 * n), 2)
        return np.vstack([v, -np.linalg.solve(mass, damping @ v + stiffness @ q)]).ravel()

    unit = np.diag(np.repeat([1.0, w], n))  # displacements and velocities of like size
    result = solve_ivp(rate, (0.0, period), unit.ravel(), method="DOP853", rtol=1e-8, atol=1e-8)
    monodromy = result.y[:, -1].reshape(2 * n, 2 * n) @ np.linalg.inv(unit)
    cos, sin = np.cos(w * period), np.sin(w * period)
    back = np.kron(np.eye(n), [[cos, sin], [-sin, cos]])
    return np.linalg.eigvals(back @ monodromy)


def test_multipliers_are_those_of_an_integration_in_time():
    _, responses = branch()
    response = min(responses, key=lambda one: abs(one.speed - 4140 * RPM))
    reference = integrated_multipliers(response)
    assert np.abs(reference - 1.0).min() < 2e-5  # a shift in time
    found = quasi_periodic_stability(BALANCE, response).multipliers
    leading = reference[np.abs(reference) > 0.9]
    assert len(leading) == 8
    for multiplier in np.delete(leading, np.argmin(np.abs(leading - 1.0))):
        assert np.abs(found - multiplier).min() < 0.01 * abs(multiplier)
