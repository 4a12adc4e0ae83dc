"""Measured orbits beside predicted ones, on orbits of the paper's rotor with noise put on."""

from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.tracking.measured import (
    FLOOR,
    agreement,
    named_harmonics,
    unit_hint,
    verdict,
)

from ...hbm.machines import PAPER

RPM = np.pi / 30.0


@cache
def responses():
    """The upper and the lower response of a bistable speed, with a mean and a phase."""
    changes = {"unbalance.disk_2.magnitude": 5.039e-4, "gravity": True}
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(3))
    found = []
    for start in (3700.0, 4300.0):
        solution = None
        for rpm in np.linspace(start, 4050.0, 40):
            solution = solve(balance, rpm * RPM, solution)
        found.append(solution)
    assert found[0].eccentricity_max > found[1].eccentricity_max + 0.2
    return found


def orbit(which):
    return named_harmonics(responses()[which].journals)


def test_names_give_the_orbit_back():
    """x = X0 + sum A_i cos(i W t - phase_i), as the node's harmonics are defined."""
    motion = responses()[0].journals["damper_1"]
    angle = np.linspace(0.0, 6.0, 7)
    named = orbit(0)
    for axis, expected in zip("xy", motion.at(angle).T, strict=True):
        stem = f"damper_1/{axis}"
        values = named[f"{stem}/0x"] + sum(
            named[f"{stem}/{i}x/amplitude"] * np.cos(i * angle - named[f"{stem}/{i}x/phase"])
            for i in (1, 2, 3)
        )
        np.testing.assert_allclose(values, expected, atol=1e-15)


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize(
    "known", ["", "1x", "amplitude", "x/1x/amplitude"], ids=["all", "1x", "no phase", "one number"]
)
def test_branch_is_recognised_from_what_is_measured(which, known):
    rng = np.random.default_rng(3)
    measured = {
        name: value + rng.normal(0.0, 0.05 if name.endswith("/phase") else 0.02 * abs(value))
        for name, value in orbit(which).items()
        if known in name
    }
    found = verdict(measured, responses())
    assert (found.best, found.decisive) == (which, True)
    assert found.agreement.disagreement < 0.15
    assert set(found.agreement.residuals) == set(measured)


def test_orbit_half_way_decides_nothing():
    upper, lower = orbit(0), orbit(1)
    measured = {
        name: 0.5 * (upper[name] + lower[name]) for name in upper if name.endswith("amplitude")
    }
    found = verdict(measured, responses())
    assert not found.decisive
    assert "from one response and" in found.message


def test_orbit_of_another_machine_decides_nothing():
    measured = {name: 10.0 * value for name, value in orbit(0).items() if "phase" not in name}
    found = verdict(measured, responses()[:1])
    assert not found.decisive
    assert found.message == "the measured orbit differs by 90 % from the nearest response"


@pytest.mark.parametrize(
    "measured",
    [
        {},
        {"damper_9/x/1x/amplitude": 1e-5, "nonsense": 1.0},
        {"damper_1/x/1x/amplitude": np.nan},
        {"damper_1/x/1x/phase": 1.0},
    ],
    ids=["nothing", "other names", "not finite", "phase alone"],
)
def test_nothing_comparable_decides_nothing(measured):
    found = verdict(measured, responses())
    assert not found.decisive
    assert found.message == "nothing measured can be compared"
    assert found.agreement.residuals == {}


def test_residuals_are_measured_minus_predicted():
    predicted = orbit(0)
    name = "damper_1/x/1x"
    phase = predicted[f"{name}/phase"]
    measured = {
        f"{name}/amplitude": predicted[f"{name}/amplitude"] + 1e-6,
        f"{name}/phase": phase + 0.1 - 4.0 * np.pi,
        "damper_1/y/0x": predicted["damper_1/y/0x"] - 2e-6,
    }
    residuals = agreement(measured, responses()[0]).residuals
    expected = {f"{name}/amplitude": 1e-6, f"{name}/phase": 0.1, "damper_1/y/0x": -2e-6}
    assert residuals == pytest.approx(expected, rel=1e-6)


def test_disagreement_is_the_difference_of_phasors():
    predicted = orbit(0)
    stem = "damper_1/x/1x"
    amplitude, phase = (predicted[f"{stem}/{part}"] for part in ("amplitude", "phase"))
    for turn in (0.0, 0.3, np.pi):
        measured = {f"{stem}/amplitude": amplitude, f"{stem}/phase": phase + turn}
        expected = abs(np.exp(1j * turn) - 1.0)
        found = agreement(measured, responses()[0]).disagreement
        assert found == pytest.approx(expected, abs=1e-12)


@cache
def circle():
    """The response without gravity, a circle, of which the orders above 1 are rounding."""
    return solve(HarmonicBalance(PAPER, Harmonics(3)), 3700.0 * RPM)


def test_phase_of_what_is_no_vibration_is_not_a_number():
    clearance = circle().journals["damper_1"].clearance
    named = named_harmonics(circle().journals)
    amplitudes = {name: value for name, value in named.items() if name.endswith("/amplitude")}
    assert len(amplitudes) == 6
    for name, amplitude in amplitudes.items():
        small = amplitude < FLOOR * clearance
        assert np.isnan(named[name.replace("amplitude", "phase")]) == small
        assert small == ("/1x/" not in name)


def test_residual_of_a_phase_below_the_floor_is_not_a_number():
    stem, clearance = "damper_1/x/1x", circle().journals["damper_1"].clearance
    for amplitude, second in ((0.5 * FLOOR * clearance, 2e-5), (1e-4, 0.5 * FLOOR * clearance)):
        measured = {f"{stem}/amplitude": amplitude, f"{stem}/phase": 1.0}
        measured |= {"damper_1/x/2x/amplitude": second, "damper_1/x/2x/phase": 1.0}
        found = agreement(measured, circle())
        assert np.isnan(found.residuals[f"{stem}/phase"]) == (amplitude < FLOOR * clearance)
        assert np.isnan(found.residuals["damper_1/x/2x/phase"])  # the prediction has none
        assert np.isfinite(found.disagreement)


CLEARANCES = {"damper_1": 2.54e-4, "b damper": 1e-4}


@pytest.mark.parametrize(
    ("measured", "hint"),
    [
        ({"damper_1/x/1x/amplitude": 2.5e-3, "damper_1/x/1x/phase": 120.0}, ""),
        ({"damper_9/x/1x/amplitude": 120.0}, ""),
        (
            {"damper_1/x/0x": -3.0, "damper_1/x/1x/amplitude": 120.6},
            "damper_1/x/1x/amplitude must be in m, where 120.6 m is 4.75e+05 times the clearance: "
            "were 120.6 um meant, which are 0.0001206 m?",
        ),
        ({"damper_1/x/1x/amplitude": 0.12}, "were 0.12 mm meant, which are 0.00012 m?"),
        ({"damper_1/x/1x/amplitude": 4.7}, "were 4.7 mil meant, which are 0.00011938 m?"),
        ({"b damper/y/0x": -0.4}, "were -0.4 of the clearance meant, which are -4e-05 m?"),
        ({"damper_1/x/1x/amplitude": 1e9}, "1e+09 m is 3.94e+12 times the clearance"),
    ],
)
def test_lengths_in_another_unit_are_told_with_that_unit(measured, hint):
    assert unit_hint(measured, CLEARANCES).endswith(hint)
    assert bool(unit_hint(measured, CLEARANCES)) == bool(hint)


@pytest.mark.parametrize(
    ("factor", "words"), [(2.0, "peak to peak amplitudes"), (0.5**0.5, "effective values")]
)
@pytest.mark.parametrize("which", [0, 1])
def test_another_measure_of_all_amplitudes_is_told(which, factor, words):
    measured = {
        name: value * (factor if name.endswith("/amplitude") else 1.0)
        for name, value in orbit(which).items()
    }
    assert words in verdict(measured, responses()).message
    single = {"damper_1/x/1x/amplitude": measured["damper_1/x/1x/amplitude"]}
    assert words not in verdict(single, responses()).message  # which may be anything
    assert words not in verdict(orbit(which), responses()).message
