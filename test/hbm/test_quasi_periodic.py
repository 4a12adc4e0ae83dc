"""Quasi-periodic responses of axisymmetric machines, from where a circular orbit loses stability.

The paper's rotor with 503.9 g mm on disk 2 does so at 4 133 rpm, on its upper branch.
"""

import itertools
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve, stability
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.oscillation import oscillation
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.quasi_periodic_branch import quasi_periodic_branch
from sfd_hbm_ros.hbm.quasi_periodic_response import (
    quasi_periodic_stability,
)
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.machine import override

from .machines import PAPER, random_machine
from .test_continuation import heavier
from .test_floquet import rotating_frame_exponents

RPM = np.pi / 30.0
BALANCE = HarmonicBalance(override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4), Harmonics(1))


@cache
def upper_circle(speed):
    """The circular orbit on the upper branch."""
    if speed < 3800.0 * RPM:
        return solve(BALANCE, speed)
    return solve(BALANCE, speed, start=upper_circle(speed - 60.0 * RPM))


def least_damped(speed):
    """Exponent of the whole rotor's least damped oscillation about the upper circle."""
    exponents = rotating_frame_exponents(BALANCE, upper_circle(speed))
    slow = exponents[(exponents.imag > 0.0) & (np.abs(exponents) < 3.0 * speed)]
    return slow[np.argmax(slow.real)]


@cache
def neimark_sacker():
    """Speed at which the whole rotor's upper circle loses stability."""
    return brentq(lambda speed: least_damped(speed).real, 4130 * RPM, 4136 * RPM, xtol=1e-9)


@cache
def branch():
    """The branch with its points and responses."""
    circle = upper_circle(neimark_sacker())
    found = quasi_periodic_branch(BALANCE, circle, (4000 * RPM, 4300 * RPM))
    return found, [found.response(point) for point in found]


def uncondensed_imbalance(balance, response):
    """Imbalance of the whole rotor's forces, relative to the films' and the unbalance's.

    The whirl at each signed frequency is judged by the assembled matrices, and the film by the
    motion in the fixed frame.
    """
    model = balance.model
    k = np.arange(-response.harmonics.highest, response.harmonics.highest + 1)
    s = response.speed + k * response.frequency
    journals = np.stack([response.whirl(name) for name in response.journals], axis=1)
    # forward whirl x + i y = Z exp(i s t) is x = Re(Z exp(i s t)), y = Re(-i Z exp(i s t))
    amplitudes = balance.condensation.at(response.speed, s / response.speed).recover(
        np.stack([journals, -1j * journals], axis=-1).reshape(len(k), -1)
    )
    forces = np.zeros_like(amplitudes)
    forces[k == 0] = response.speed**2 * model.unbalance
    t = 2.0 * np.pi / response.frequency * np.arange(512) / 512
    carriers = np.exp(1j * np.multiply.outer(t, s))
    for film, whirl, coordinates in zip(balance.films, journals.T, model.journals, strict=True):
        z = [carriers @ (whirl * (1j * s) ** order) for order in (0, 1, 2)]
        pushed = film.force(*(np.stack([one.real, one.imag], axis=1) for one in z))
        turned = (pushed[:, 0] + 1j * pushed[:, 1]) * np.exp(-1j * response.speed * t)
        spectrum = np.fft.fft(turned)[k] / len(t)
        forces[:, coordinates] += np.stack([spectrum, -1j * spectrum], axis=1)
    moved = [
        (model.K - w * w * model.M + 1j * w * (model.C + response.speed * model.G)) @ q
        for w, q in zip(s, amplitudes, strict=True)
    ]
    return np.linalg.norm(moved - forces) / np.linalg.norm(forces)


def test_whole_rotor_is_in_balance():
    _, responses = branch()
    for response in responses[::4]:
        # nearer to the clearance the films' spectra outgrow the time samples of the balance
        limit = 1e-9 if response.eccentricity_max < 0.985 else 1e-6
        assert uncondensed_imbalance(BALANCE, response) < limit


def random_onset(seed, dampers, start, end):
    """The speed at which a random machine's circle loses stability, and the circle."""
    machine = heavier(random_machine(seed, dampers=dampers), 2.0)
    balance = HarmonicBalance(machine, Harmonics(1))
    circles = Branch(SpeedFamily(balance), solve(balance, start).coefficients.ravel(), start, end)

    def growth(point):
        circle = solution_at(balance, point.value, point.x)
        return oscillation(balance, circle).exponent.real

    before, after = next(
        pair
        for pair in itertools.pairwise(circles)
        if growth(pair[0]) < 0.0 < growth(pair[1]) and pair[1].eccentricity > 0.9
    )
    point = locate(circles, before, after, growth)
    return balance, solution_at(balance, point.value, point.x)


@pytest.mark.parametrize(("seed", "dampers"), [(713, 1), (714, 2)])
def test_random_machines(seed, dampers):
    """The branch leaves the circle with the circle's own frequency and keeps the balance."""
    balance, circle = random_onset(seed, dampers, 150.0, 700.0)
    found = quasi_periodic_branch(balance, circle, (150.0, 700.0))
    responses = [found.response(point) for point in itertools.islice(found, 8)]
    assert responses[0].speed == pytest.approx(circle.speed, rel=1e-4)
    frequency = oscillation(balance, circle).exponent.imag
    assert responses[0].frequency == pytest.approx(frequency, rel=1e-4)
    assert responses[-1].amplitude > 0.08
    for response in responses:
        assert uncondensed_imbalance(balance, response) < 1e-9


def test_frequency_at_the_onset_is_the_argument_of_the_multiplier():
    circle = upper_circle(neimark_sacker())
    frequency = least_damped(circle.speed).imag
    assert oscillation(BALANCE, circle).exponent.imag == pytest.approx(frequency, rel=1e-5)
    leading = stability(BALANCE, circle).multipliers[0]
    turned = np.exp(2j * np.pi * frequency / circle.speed)
    assert abs(turned - 1.0) > 1e-3
    assert min(abs(leading - turned), abs(leading.conj() - turned)) < 2e-5
    _, responses = branch()
    assert responses[0].frequency == pytest.approx(frequency, rel=1e-5)


def test_amplitude_grows_with_the_root_of_the_distance_from_the_onset():
    _, responses = branch()
    beginning = [one for one in responses if one.amplitude < 0.1]
    assert len(beginning) >= 3
    for quantity, onset in (
        ("speed", neimark_sacker()),
        ("frequency", least_damped(neimark_sacker()).imag),
    ):
        rates = [(getattr(one, quantity) - onset) / one.amplitude**2 for one in beginning]
        assert rates == pytest.approx(np.full(len(rates), rates[0]), rel=0.02)


def test_branch_ends_on_the_clearance_near_the_pinned_critical_speed():
    found, responses = branch()
    assert found.stop is Stop.CLEARANCE
    speeds = np.array([one.speed for one in responses]) / RPM
    assert np.all(np.diff(speeds) > 0.0)
    assert 4159.0 < speeds[-1] < 4162.0
    stable = [quasi_periodic_stability(BALANCE, one).stable for one in responses[::8]]
    assert all(stable[:-1])


def test_more_multiples_change_little():
    _, responses = branch()
    response = min(responses, key=lambda one: abs(one.speed - 4150 * RPM))
    circle = upper_circle(neimark_sacker())
    finer = quasi_periodic_branch(BALANCE, circle, (4000 * RPM, response.speed), Harmonics(25))
    *_, last = finer
    assert last.value == response.speed
    other = finer.response(last)
    assert other.eccentricity_max == pytest.approx(response.eccentricity_max, abs=1e-4)
    assert other.frequency == pytest.approx(response.frequency, rel=1e-6)


def test_machine_without_circles_is_refused():
    balance = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(3))
    with pytest.raises(ValueError, match="must be axisymmetric, without gravity"):
        quasi_periodic_branch(balance, solve(balance, 300.0), (200.0, 500.0))
