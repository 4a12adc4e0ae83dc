"""The benchmarks' oscillator, and our continuation of it, against Duffing's closed form."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.peers.duffing import duffing_branch
from benchmarks.peers.oscillator import Duffing
from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.hbm.events import with_folds
from sfd_hbm_ros.hbm.points import Stop

LOW, HIGH = 0.5, 2.5


def closed_form(oscillator, w, amplitude):
    """Force that one harmonic of an amplitude takes (Nayfeh and Mook 1979, sec. 4.1)."""
    stiffness = 1.0 - w**2 + 0.75 * oscillator.cubic * amplitude**2
    return amplitude * np.hypot(stiffness, oscillator.damping * w)


def test_branch_obeys_the_closed_form_of_one_harmonic():
    oscillator = Duffing(Harmonics(1))
    branch = duffing_branch(oscillator, LOW, HIGH, 0.02)
    points = list(with_folds(branch, branch))
    assert branch.stop is Stop.RANGE
    assert sum(fold for _, fold in points) == 2
    for point, _ in points:
        amplitude = np.hypot(*point.x[1:3])
        assert closed_form(oscillator, point.value, amplitude) == pytest.approx(1.0, abs=1e-8)


def test_peak_is_that_of_the_closed_form():
    """Its derivative by w vanishes at w^2 = 1 + 3/4 b A^2 - d^2/2."""
    oscillator = Duffing(Harmonics(1))
    points = list(duffing_branch(oscillator, LOW, HIGH, 0.002))
    peak = max(points, key=lambda point: np.hypot(*point.x[1:3]))
    amplitude = np.hypot(*peak.x[1:3])
    square = 1.0 + 0.75 * oscillator.cubic * amplitude**2 - 0.5 * oscillator.damping**2
    assert closed_form(oscillator, np.sqrt(square), amplitude) == pytest.approx(1.0, rel=1e-5)
    # the peak is flat in the amplitude, not in the frequency, where points lie 4e-3 apart
    assert peak.value == pytest.approx(np.sqrt(square), abs=4e-3)


def test_derivatives_are_those_of_the_residual():
    oscillator, step = Duffing(Harmonics(5)), 1e-5
    x, w = np.random.default_rng(1).normal(size=oscillator.harmonics.rows), 1.3
    columns = [
        (oscillator.residual(x + e, w) - oscillator.residual(x - e, w)) / (2.0 * step)
        for e in step * np.eye(x.size)
    ]
    assert np.allclose(np.transpose(columns), oscillator.jacobian(x, w), rtol=1e-7, atol=1e-7)
    slope = (oscillator.residual(x, w + step) - oscillator.residual(x, w - step)) / (2.0 * step)
    assert np.allclose(slope, oscillator.slope(x, w), rtol=1e-7, atol=1e-7)


def test_seven_harmonics_agree_with_time_integration():
    oscillator = Duffing(Harmonics(7, 128))
    *_, last = duffing_branch(oscillator, 0.5, 0.8, 0.02)
    period = 2.0 * np.pi / 0.8

    def rates(time, state):
        q, v = state
        force = np.cos(0.8 * time) - oscillator.damping * v - q - oscillator.cubic * q**3
        return [v, force]

    times = period * np.arange(128) / 128
    motion = solve_ivp(
        rates,
        (0.0, 80.0 * period),
        [0.0, 0.0],
        t_eval=79.0 * period + times,
        rtol=1e-10,
        atol=1e-10,
        method="DOP853",
    )
    orbit = oscillator.harmonics.bases[0] @ last.x
    assert np.abs(motion.y[0] - orbit).max() < 1e-4
