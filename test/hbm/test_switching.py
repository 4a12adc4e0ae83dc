"""Branches that leave others: a response of twice the period, judged by time integration."""

from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve, stability
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.selection import SelectedBalance
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.hbm.switching import absent_coefficients, null_vector, over, switch
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.ramp import Ramp

from .machines import misaligned_rotor

BALANCE = HarmonicBalance(misaligned_rotor(), Harmonics(6))
FAMILY = SpeedFamily(BALANCE)
BOUNDS = (700.0, 1300.0)
DOUBLED = over(FAMILY, BALANCE.harmonics, 2)
HALVES = np.array(DOUBLED.balance.harmonics.multiples) % 2 == 1


@cache
def period_doubling():
    """Speed at which the Floquet multiplier of the synchronous response passes -1."""

    def beyond(speed):
        return stability(BALANCE, solve(BALANCE, speed)).multipliers.real.min() + 1.0

    return brentq(beyond, 830.0, 850.0, xtol=1e-6)


@cache
def points():
    """The branch of the period doubling."""
    speed = period_doubling()
    return list(switch(FAMILY, speed, solve(BALANCE, speed), 2, BOUNDS))


def half_orders(x):
    """Amplitudes of the half orders in coefficients of the doubled equations, of the clearance."""
    amplitudes = DOUBLED.balance.harmonics.amplitudes(x.reshape(-1, 2))
    return np.abs(amplitudes[HALVES]) / BALANCE.clearances


def test_balance_over_two_revolutions_is_singular_at_the_multiplier_of_minus_one():
    def determinant(speed):
        solution = solve(BALANCE, speed)
        equations = DOUBLED.at(speed)
        x = DOUBLED.balance.harmonics.change_from(solution.harmonics, solution.coefficients)
        absent = absent_coefficients(DOUBLED.balance, x)
        _, jacobian = equations.linearise(x.ravel())
        return np.linalg.slogdet(jacobian[np.ix_(absent, absent)])[0]

    assert determinant(830.0) == -determinant(850.0)
    singular = brentq(determinant, 830.0, 850.0, xtol=1e-6)
    assert singular == pytest.approx(period_doubling(), abs=0.05)


def test_null_vector_is_one_of_the_whole_jacobian():
    speed = period_doubling()
    solution = solve(BALANCE, speed)
    x = DOUBLED.balance.harmonics.change_from(solution.harmonics, solution.coefficients)
    equations = DOUBLED.at(speed)
    absent = absent_coefficients(DOUBLED.balance, x)
    vector = null_vector(equations, x.ravel(), absent)
    scaled = equations.linearise(x.ravel())[1] * equations.scale
    smallest = np.linalg.svd(scaled, compute_uv=False)
    assert np.linalg.norm(scaled @ vector) < 1e-3 * smallest[-2]
    assert np.abs(vector.reshape(x.shape)[~absent.reshape(x.shape)]).max() == 0.0


def test_branch_leaves_with_the_root_of_the_distance():
    """The square of the half orders grows linearly from nothing at the period doubling."""
    near = points()[:4]
    assert half_orders(near[-1].x).max() < 0.1
    square = [(half_orders(at.x) ** 2).sum() for at in near]
    slope, _ = np.polyfit([at.value for at in near], square, 1)
    onset = near[0].value - square[0] / slope
    assert slope > 0.0
    assert onset == pytest.approx(period_doubling(), abs=0.05)
    distances = np.array([at.value for at in near]) - onset
    exponent, _ = np.polyfit(np.log(distances), 0.5 * np.log(square), 1)
    assert exponent == pytest.approx(0.5, abs=0.02)


def test_image_one_revolution_later_is_a_response_too():
    point = points()[-1]
    shifted = point.x.reshape(-1, 2).copy()
    rows = np.concatenate([HALVES[:1], np.repeat(HALVES[1:], 2)])
    shifted[rows] *= -1.0
    equations = DOUBLED.at(point.value)
    assert half_orders(point.x).max() > 0.3
    assert np.linalg.norm(equations.residual(shifted.ravel())) < 1e-9 * equations.load


def test_motion_in_time_repeats_after_two_revolutions():
    """Begun with the synchronous response of a lower speed, at which that is still stable."""
    speed, c = 950.0, BALANCE.clearances[0]
    start = solve(BALANCE, 830.0)
    assert stability(BALANCE, start).stable
    assert stability(BALANCE, solve(BALANCE, speed)).multipliers[0].real < -1.2
    ramp = Ramp(speed, 0.0, 50)
    integrator = Integrator(BALANCE, speed)
    state, revolutions = integrator.start(start), []
    for number in range(ramp.revolutions):
        state, positions = integrator.revolution(ramp, number, state)
        revolutions.append(positions / c)
    first, second, third = revolutions[-3:]
    assert np.abs(third - first).max() < 1e-5
    assert np.abs(second - first).max() > 0.5

    balance = HarmonicBalance(BALANCE.machine, Harmonics(9, revolutions=2))
    near = min(points(), key=lambda at: abs(at.value - speed))
    guess = balance.harmonics.change_from(DOUBLED.balance.harmonics, near.x.reshape(-1, 2))
    result = newton(balance.at(speed), guess.ravel())
    assert result.outcome.converged
    doubled = solution_at(balance, speed, result.x)
    assert stability(balance, doubled).stable
    orbit = doubled.journals["damper"].orbit(2 * len(first)).reshape(2, -1, 2) / c
    integrated = np.array([first, second])
    assert min(np.abs(integrated - image).max() for image in (orbit, orbit[::-1])) < 1e-4


def test_selection_keeps_half_orders_on_the_new_branch_alone():
    trial = DOUBLED.balance.harmonics
    balance = SelectedBalance(BALANCE.machine, trial, 1e-3)
    near = min(points(), key=lambda at: abs(at.value - 1000.0))
    synchronous, _, _ = balance.solve(near.value)
    assert all(multiple % 2 == 0 for multiple in synchronous)
    nothing = balance.neglect(trial.multiples, near.value, near.x)
    group = balance.adapt(trial.multiples, near.x, nothing)
    assert {1, 3, 5} < set(group)
    start = balance.regroup(trial.multiples, group, near.x)
    result = newton(balance.balance(group).at(near.value), start)
    assert result.outcome.converged
    neglect = balance.neglect(group, near.value, result.x)
    assert neglect.error <= 1e-3
    step = balance.embed(group, result.x) - near.x
    assert DOUBLED.at(near.value).eccentricity(step) <= neglect.error
