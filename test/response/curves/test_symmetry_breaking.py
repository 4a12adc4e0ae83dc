"""A response that loses its symmetry, with a closed form: a journal on a buckling spring.

No machine was found whose film breaks a symmetry by itself below an eccentricity of 0.9. In the
film's place acts f_x = k x - k3 x^3. With x = x0 + a cos(angle) its mean force balances the
centring spring kc where

    (k - kc) x0 = k3 (x0^3 + 3/2 a^2 x0),

so that the orbit is centred for kc > k - 3/2 k3 a^2 and leaves the centre below.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from sfd_hbm_ros.film import FILMS, FilmForces
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Instability
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import parameter_curve
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.summary import Summary

from ...hbm.machines import misaligned_rotor

K, K3, CLEARANCE = 1.5e5, 3e12, 2.54e-4


@dataclass(frozen=True)
class BucklingSpring:
    """A film's place taken by a spring that pushes the journal off the centre in x."""

    clearance: float = CLEARANCE
    centred_damping: float = 200.0
    centred_inertia: float = 0.0

    def force(self, position, velocity, acceleration):
        return self.linearise(position, velocity, acceleration).force

    def linearise(self, position, velocity, acceleration):
        x, y = position.T
        force = np.column_stack([K * x - K3 * x**3, -K * y]) - self.centred_damping * velocity
        by_position = np.zeros((len(x), 2, 2))
        by_position[:, 0, 0], by_position[:, 1, 1] = K - 3.0 * K3 * x**2, -K
        by_velocity = np.broadcast_to(-self.centred_damping * np.eye(2), by_position.shape)
        return FilmForces(force, by_position, by_velocity, np.zeros_like(by_position))


@pytest.fixture
def curve(monkeypatch):
    monkeypatch.setitem(FILMS, "short", lambda damper: BucklingSpring())
    machine = override_all(misaligned_rotor(), {"loads": [], "unbalance.disk.magnitude": 5e-5})
    balance = HarmonicBalance(machine, Harmonics(5))
    return parameter_curve(balance, 500.0, "dampers.damper.centering_stiffness", 2e5, 1e5)


def mean_and_amplitude(solution):
    """Mean x0 and amplitude a of the 1x motion in x [m]."""
    amplitudes = solution.harmonics.amplitudes(solution.coefficients)[:, 0]
    return amplitudes[0].real, abs(amplitudes[1])


def test_orbit_leaves_the_centre_as_the_closed_form_says(curve):
    centred, displaced = curve.branches
    [(kind, mark)] = Summary(curve).instabilities
    assert kind is Instability.SYMMETRY_BREAKING
    mean, amplitude = mean_and_amplitude(displaced.solutions[0])
    assert abs(mean) < 1e-9 * CLEARANCE
    assert 0.02 < amplitude / CLEARANCE < 0.1
    assert displaced.values[0] == mark.value
    assert mark.value == pytest.approx(K - 1.5 * K3 * amplitude**2, abs=0.05 * (K - mark.value))
    assert displaced.stable.all()
    assert displaced.values[-1] == centred.values[-1] == 1e5
    for stiffness, solution in zip(displaced.values[1:], displaced.solutions[1:], strict=True):
        mean, amplitude = mean_and_amplitude(solution)
        expected = (K - stiffness) / K3 - 1.5 * amplitude**2
        assert mean**2 == pytest.approx(expected, rel=0.02)


def test_machine_follows_the_displaced_orbit_without_a_jump(curve):
    centred, displaced = curve.branches
    assert not centred.stable[-1]
    assert displaced.worst_eccentricity[-1] > centred.worst_eccentricity[-1] + 0.3
    assert [jumps(curve, direction) for direction in Direction] == [[], []]
