"""A quasi-periodic response against an integration in time that begins with it."""

import numpy as np
import pytest

from sfd_hbm_ros.response.integration.integrator import Integrator, State
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.rotor import Condensation

from ...hbm.test_quasi_periodic import BALANCE, RPM, branch


class Motion:
    """The motion of a quasi-periodic response as the fixed frame sees it."""

    def __init__(self, response):
        k = np.arange(-response.harmonics.highest, response.harmonics.highest + 1)
        self.speed = response.speed
        self.frequencies = response.speed + k * response.frequency
        self.whirl = response.whirl("damper_1")

    def at(self, time, derivative=0):
        """x + i y of the journal."""
        carriers = np.exp(1j * np.multiply.outer(time, self.frequencies))
        return carriers @ (self.whirl * (1j * self.frequencies) ** derivative)

    def state(self, integrator):
        """The rotor's state at time 0."""
        amplitudes = (
            Condensation(integrator.rotor)
            .at(self.speed, self.frequencies / self.speed)
            .recover(np.stack([self.whirl, -1j * self.whirl], axis=1))
        )
        steps, nodes = integrator.options.steps, integrator.radau.nodes
        times = np.add.outer(np.arange(steps), nodes) * 2.0 * np.pi / self.speed / steps
        acceleration = self.at(times, 2)
        return State(
            amplitudes.real.sum(axis=0),
            (1j * self.frequencies @ amplitudes).real,
            np.stack([acceleration.real, acceleration.imag], axis=-1),
        )


def test_motion_goes_on_in_time():
    """Over eight revolutions, in which the film forgets all but a motion of its own."""
    _, responses = branch()
    response = min(responses, key=lambda one: abs(one.speed - 4140 * RPM))
    motion, clearance = Motion(response), BALANCE.clearances[0]
    integrator = Integrator(BALANCE, response.speed)
    state, revolutions = motion.state(integrator), 8
    period, backward = 2.0 * np.pi / response.speed, []
    for number in range(revolutions):
        state, positions = integrator.revolution(Ramp(response.speed, 0.0, 1), 0, state)
        time = period * (number + np.arange(len(positions)) / len(positions))
        z = positions[:, 0] + 1j * positions[:, 1]
        assert np.abs(z - motion.at(time)).max() < 1e-3 * clearance
        backward.append(np.mean(z * np.exp(1j * response.speed * time)))
    assert np.ptp(np.abs(z)) > 0.05 * clearance
    assert np.abs(z).max() / clearance == pytest.approx(response.eccentricity_max, abs=1e-4)
    # the backward whirl at W - w turns slowly against one at -W
    turned = np.unwrap(np.angle(backward))
    precession = (turned[-1] - turned[0]) / ((revolutions - 1) * period)
    assert precession == pytest.approx(2.0 * response.speed - response.frequency, rel=0.01)
