"""Measured orbits over DDS: they settle the branch and show what the model lacks."""

import math

import pytest

from .graph import JointState, Numbers, Remote, numbers  # first, as it skips the file without ROS

# isort: split
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve
from sfd_hbm_ros.response.tracking.measured import named_harmonics
from sfd_hbm_ros.response.tracking.settling import CONFIRMATIONS

from .bistable import BOTH, LOWER_ONLY, MACHINE, UPPER_ONLY, Topics, begin, orbits, settle_at

OK, WARN = b"\x00", b"\x01"
BALANCE = HarmonicBalance(MACHINE, Harmonics(1))


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    """Of a machine that it has seen at no other speed than one where it is bistable."""
    return begin(start, graph, tmp_path_factory.mktemp("machine"), BOTH)


@pytest.fixture(scope="module")
def measured(predictor) -> Topics:
    return Topics(predictor, "measured", "residual")


def orbit(start: float) -> Numbers:
    """The harmonics at the bistable speed when the machine comes from another one."""
    solution: Solution = solve(BALANCE, start)
    for part in range(1, 21):
        solution = solve(BALANCE, start + part / 20 * (BOTH - start), solution)
    return named_harmonics(solution.journals)


def report(topics: Topics, harmonics: Numbers) -> JointState:
    """Predict at the bistable speed, report a measured orbit, and return the residuals."""
    stamp = topics.remote.now()
    topics.remote.predict(BOTH, stamp)
    return topics.ask(stamp, name=list(harmonics), position=list(harmonics.values()))


def branch(predictor: Remote) -> float:
    """The eccentricity of the branch that the predictor is on."""
    return predictor.predict(BOTH)[0]["damper_1/max"]


def test_the_first_orbit_settles_the_branch(predictor, measured):
    """Which is assumed before depends on what came first, the curve or a speed."""
    lower, upper = orbits(BOTH)
    assumed = settle_at(predictor, BOTH)["damper_1/max"]
    on_lower = assumed == pytest.approx(lower, abs=1e-8)
    assert on_lower or assumed == pytest.approx(upper, abs=1e-8)
    assert branch_name(predictor) == "unknown"
    # jumps lie some 19 rpm above and below, which both are within the limit of an error
    both = predictor.until_warning(b"\x02", "on which of 2 responses the machine is", BOTH)
    message = predictor.warnings[-1][1].message
    for part in ("up to eccentricity", "down to eccentricity", "~/measured would settle it"):
        assert part in message
    assert 15.0 < float(both["margin_rpm"]) < 20.0
    assert both["next_jump_damper"] == "damper_1"
    report(measured, orbit(UPPER_ONLY if on_lower else LOWER_ONLY))
    assert branch(predictor) == pytest.approx(upper if on_lower else lower, abs=1e-8)
    name = "upper" if on_lower else "lower"
    predictor.graph.until(lambda: branch_name(predictor) == name, "the branch is settled")


def branch_name(predictor: Remote) -> str:
    return {pair.key: pair.value for pair in predictor.statuses["Jump"].values}["branch"]


def test_a_settled_branch_is_left_after_several_orbits_alone(predictor, measured):
    lower, upper = orbits(BOTH)
    other = orbit(UPPER_ONLY)
    predictor.predict(LOWER_ONLY)
    for _ in range(CONFIRMATIONS - 1):
        report(measured, other)
        assert branch(predictor) == pytest.approx(lower, abs=1e-8)
    report(measured, other)
    assert branch(predictor) == pytest.approx(upper, abs=1e-8)
    for _ in range(CONFIRMATIONS):
        report(measured, orbit(LOWER_ONLY))
    assert branch(predictor) == pytest.approx(lower, abs=1e-8)


def test_residuals_are_measured_minus_predicted(predictor, measured):
    lower = orbit(LOWER_ONLY)
    predictor.predict(LOWER_ONLY)
    offsets = {
        "damper_1/x/0x": 2e-6,
        "damper_1/x/1x/amplitude": -3e-6,
        "damper_1/x/1x/phase": 0.04,
        "damper_1/y/1x/amplitude": 1e-6,
    }
    off = {name: lower[name] + offset for name, offset in offsets.items()}
    assert numbers(report(measured, off)) == pytest.approx(offsets, abs=1e-10)
    predictor.until_status("Model", OK, "the measured orbit differs by")


def test_a_poor_agreement_is_warned_of_at_the_threshold(predictor, measured):
    lower = orbit(LOWER_ONLY)
    predictor.predict(LOWER_ONLY)
    larger = {name: 1.1 * value for name, value in lower.items() if name.endswith("/amplitude")}
    report(measured, larger)
    predictor.until_status("Model", OK, "differs by 9 %")
    assert predictor.set({"measured.warn": 0.05}).successful
    status = predictor.until_status("Model", WARN, "differs by 9 %")
    values = {pair.key: pair.value for pair in status.values}
    assert float(values["measured: disagreement"]) == pytest.approx(1.0 - 1.0 / 1.1, abs=1e-3)
    report(measured, lower)
    predictor.until_status("Model", OK, "differs by 0 %")


@pytest.mark.parametrize(
    ("harmonics", "late", "reason"),
    [
        ({"damper_1/x/1x": 1.0}, 0, "must be the name of a harmonic"),
        ({"damper_1/x/1x/amplitude": math.nan}, 0, "must be a finite number of at least 0"),
        ({"damper_9/x/1x/amplitude": 1e-6}, 0, "nothing measured can be compared"),
        ({"damper_1/x/1x/amplitude": 1e-6}, 1000, "s from that of the nearest prediction"),
    ],
)
def test_orbits_of_no_use_are_dropped_with_the_reason(
    predictor, measured, harmonics, late, reason
):
    predictor.predict(BOTH)
    stamp = predictor.now() - late * 1_000_000_000
    measured.send(stamp, name=list(harmonics), position=list(harmonics.values()))
    predictor.until_status("Inputs", WARN, reason)
    assert stamp not in measured.answers
