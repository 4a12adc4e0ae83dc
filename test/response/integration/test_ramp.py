"""Runs at a constant rate of the speed."""

import numpy as np
import pytest

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.integration.ramp import Ramp


@pytest.mark.parametrize("acceleration", [-30.0, 0.0, 200.0])
def test_angle_is_the_integral_of_the_speed(acceleration):
    ramp = Ramp(300.0, acceleration, 100)
    revolutions = np.linspace(0.0, 100.0, 11)
    t = ramp.time(revolutions)
    angle = 300.0 * t + 0.5 * acceleration * t**2
    assert angle == pytest.approx(2.0 * np.pi * revolutions, rel=1e-12)
    assert ramp.speed(revolutions) == pytest.approx(300.0 + acceleration * t, rel=1e-12)


@pytest.mark.parametrize("acceleration", [-30.0, 0.0, 500.0])
def test_unbalance_turns_as_its_mass_accelerates(acceleration):
    """A mass at exp(i angle) pushes with the reverse of its acceleration, here differenced."""
    ramp, nodes = Ramp(300.0, acceleration, 100), np.array([0.0, 0.3, 1.0])
    stages = ramp.stages(17.25, 0.125, nodes)
    begin = ramp.time(np.array([17.25]))
    assert stages.length == pytest.approx(float(ramp.time(np.array([17.375]))[0] - begin[0]))
    time, step = begin + stages.length * nodes, 1e-4

    def place(t):
        return np.exp(1j * (300.0 * t + 0.5 * acceleration * t**2))

    differences = sum(
        weight * place(time + shift * step)
        for weight, shift in ((-1, -2), (16, -1), (-30, 0), (16, 1), (-1, 2))
    )
    assert np.abs(stages.turning + differences / (12.0 * step**2)).max() < 1e-5 * 300.0**2


@pytest.mark.parametrize(
    ("start", "end", "direction"),
    [(300.0, 400.0, Direction.RUN_UP), (400.0, 300.0, Direction.COAST_DOWN)],
)
def test_between_ends_with_the_last_whole_revolution(start, end, direction):
    ramp = Ramp.between(start, end, 7.0)
    assert ramp.direction is direction
    last, after = ramp.speed(np.array([ramp.revolutions, ramp.revolutions + 1.0]))
    assert abs(last - start) <= abs(end - start) < abs(after - start)


def test_whole_revolutions_are_counted_whole():
    """From 3900 to 4200 rpm at 30 rpm/s: (4200^2 - 3900^2)/(2 30 60) = 675."""
    rpm = np.pi / 30.0
    assert Ramp.between(3900.0 * rpm, 4200.0 * rpm, 30.0 * rpm).revolutions == 675


def test_constant_speed_has_no_direction():
    assert Ramp(300.0, 0.0, 1).direction is None


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Ramp(0.0, 1.0, 9), "start: 0.0 rad/s is not allowed, it must be positive and"),
        (lambda: Ramp(300.0, 1.0, 0), "revolutions: 0 is not allowed, it must be at least 1"),
        (lambda: Ramp(300.0, -1e3, 99), "acceleration: -1000.0 rad/s2 is not allowed, the rotor"),
        (lambda: Ramp(300.0, np.nan, 9), "acceleration: nan rad/s2 is not allowed"),
        (lambda: Ramp.between(300.0, np.inf, 1.0), "end: inf rad/s is not allowed"),
        (lambda: Ramp.between(300.0, 400.0, -1.0), "rate: -1.0 rad/s2 is not allowed"),
        (lambda: Ramp.between(300.0, 400.0, 1e5), "rate: 100000 rad/s2 leads from 300 to 400"),
        (lambda: Ramp.between(300.0, 300.0, 1.0), "rate: 1 rad/s2 leads from 300 to 300 rad/s in"),
    ],
)
def test_bad_numbers_are_refused(make, sentence):
    with pytest.raises(ValueError, match=sentence):
        make()
