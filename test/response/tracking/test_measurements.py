"""What measured orbits say of a machine: noise and jumps say nothing, another machine does."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.tracking.measured import (
    agreement,
    measured_eccentricities,
    named_harmonics,
)
from sfd_hbm_ros.response.tracking.measurements import FEWEST, GONE, UNSEEN, Measurements

from ...hbm.machines import PAPER

RPM = np.pi / 30.0
RATE = 10.0  # Hz, of orbits
WARN = 0.15  # the node's default
AGE = 1.0  # s
SPEEDS = (2000.0, 2500.0, 3000.0, 3500.0, 3900.0, 4100.0, 4150.0, 4500.0, 5500.0)


@cache
def run_up(unbalance: float) -> dict[float, Solution]:
    """Responses of the paper's rotor on its way up, with the harmonics of the node."""
    changes = {"unbalance.disk_2.magnitude": unbalance}
    balance, last = HarmonicBalance(override_all(PAPER, changes), Harmonics(7)), None
    found = {}
    for rpm in sorted({*np.arange(2000.0, 4150.0, 50.0), *SPEEDS}):
        found[rpm] = last = solve(balance, rpm * RPM, last)
    return found


def noisy(solution: Solution, deviation: float, rng: np.random.Generator) -> dict[str, float]:
    """The orbit with errors as the simulator makes them [m]."""
    journals = {
        name: replace(
            motion,
            coefficients=motion.coefficients
            + deviation * rng.standard_normal(motion.coefficients.shape),
        )
        for name, motion in solution.journals.items()
    }
    return named_harmonics(journals)


@pytest.mark.parametrize("deviation", [3e-7, 1.5e-6], ids=["demo", "five times"])
@pytest.mark.parametrize("rpm", SPEEDS)
def test_noise_makes_no_other_machine(rpm, deviation):
    rng, measurements = np.random.default_rng(7), Measurements()
    solution = run_up(5.039e-4)[rpm]
    for i in range(100):
        now = i / RATE
        measurements.compare(agreement(noisy(solution, deviation, rng), solution), now)
        assert not measurements.seen(WARN, now, AGE).differs


@pytest.mark.parametrize("rpm", [3900.0, 4100.0])
def test_another_unbalance_is_found_before_its_jump(rpm):
    """With 15 % less the machine does not jump at all."""
    rng, measurements = np.random.default_rng(7), Measurements()
    machine, model = run_up(5.039e-4)[rpm], run_up(0.85 * 5.039e-4)[rpm]
    told = []
    for i in range(30):
        measurements.compare(agreement(noisy(machine, 3e-7, rng), model), i / RATE)
        told.append(measurements.seen(WARN, i / RATE, AGE).differs)
    assert told == [False] * (FEWEST - 1) + [True] * (31 - FEWEST)


def test_a_jump_on_its_way_makes_no_other_machine():
    """For half a second the machine is still above where the model is below, each way."""
    upper, lower = run_up(5.039e-4)[4150.0], run_up(5.039e-4)[4500.0]
    measurements = Measurements()
    for i in range(60):
        jumping = 20 <= i < 25 or 40 <= i < 45
        model = lower if 20 <= i < 45 else upper
        other = upper if model is lower else lower
        orbit = named_harmonics((other if jumping else model).journals)
        measurements.compare(agreement(orbit, model), i / RATE)
        assert not measurements.seen(WARN, i / RATE, AGE).differs


def test_agreement_comes_back_when_the_model_is_mended():
    machine, model = run_up(5.039e-4)[4100.0], run_up(0.85 * 5.039e-4)[4100.0]
    orbit, measurements = named_harmonics(machine.journals), Measurements()
    for i in range(30):
        measurements.compare(agreement(orbit, model), i / RATE)
    assert measurements.seen(WARN, 2.9, AGE).differs
    for i in range(30, 60):
        measurements.compare(agreement(orbit, machine), i / RATE)
    assert not measurements.seen(WARN, 5.9, AGE).differs


def test_what_is_old_is_not_known_and_what_is_gone_holds_nothing():
    measurements = Measurements()
    unseen = UNSEEN._replace(threshold=WARN)
    assert measurements.seen(WARN, 0.0, AGE) == pytest.approx(unseen, nan_ok=True)
    for now in (0.0, 0.1, 0.2):
        measurements.see({"damper_1": 0.91, "damper_2": 0.3}, now)
    assert measurements.seen(WARN, 0.3, AGE).eccentricity == 0.91
    assert math.isnan(measurements.seen(WARN, 2.0, AGE).eccentricity)
    assert measurements.eccentricities(2.0, AGE) == {}
    assert measurements.seen(WARN, 0.3 + GONE, AGE).eccentricity == -math.inf


def test_a_single_orbit_does_not_move_the_eccentricity():
    measurements = Measurements()
    for eccentricity in (0.5, 0.97, 0.51):
        measurements.see({"damper_1": eccentricity}, 0.0)
    assert measurements.seen(WARN, 0.0, AGE).eccentricity == 0.51
    assert measurements.eccentricities(0.0, AGE) == {"damper_1": 0.51}


def test_measured_eccentricity_is_that_of_the_orbit():
    changes = {"unbalance.disk_2.magnitude": 5.039e-4, "gravity": True}
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(5))
    solution = solve(balance, 3700.0 * RPM)
    motion = solution.journals["damper_1"]
    clearances = {"damper_1": motion.clearance, "damper_2": 1e-4}
    whole = named_harmonics(solution.journals)
    found = measured_eccentricities(whole, clearances)
    assert found == {"damper_1": pytest.approx(motion.eccentricity_max, rel=1e-3)}
    amplitudes = {"damper_1/x/1x/amplitude": 2e-4, "damper_1/y/1x/amplitude": 1.5e-4}
    found = measured_eccentricities(amplitudes, clearances)  # the greater half axis
    assert found["damper_1"] == pytest.approx(2e-4 / motion.clearance, rel=1e-3)
    slow = {
        "damper_1/x/0.5x/amplitude": 1e-4,
        "damper_1/x/0.5x/phase": 1.0,
        "damper_1/x/0x": -1e-5,
    }
    found = measured_eccentricities(slow, clearances)
    assert found["damper_1"] == pytest.approx(1.1e-4 / motion.clearance, rel=1e-3)
    assert measured_eccentricities({"damper_9/x/0x": 1.0}, clearances) == {}
