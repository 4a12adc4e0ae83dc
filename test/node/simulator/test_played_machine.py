"""The machine that the simulator plays: it jumps where circular-orbit theory says, and on request.

The jumps at 3 985 and 4 162 rpm are those of the reconstructed paper rotor with 503.9 g mm on
disk 2: it is multi-valued from about 3 985 rpm up to its pinned-pinned critical speed.
"""

import math
from itertools import pairwise

import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, read_machine
from sfd_hbm_ros.node.simulator.integrated_machine import IntegratedMachine
from sfd_hbm_ros.node.simulator.played_machine import (
    BareSpeed,
    JumpError,
    PlayedMachine,
    TrackedMachine,
)
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve

from ..process import PAPER_ROTOR

RPM = math.pi / 30.0  # rad/s
EVER = 1e9  # s of patience
RUN = SpeedProfile(from_rpm=3800.0, to_rpm=4300.0, rpm_per_second=100.0, hold=1.0)
STEADY = SpeedProfile(from_rpm=4100.0, to_rpm=4100.0, hold=100.0)


@pytest.fixture(scope="module")
def curve() -> ResponseCurve:
    machine = override(read_machine(PAPER_ROTOR), "unbalance.disk_2.magnitude", 5.039e-4)
    return response_curve(HarmonicBalance(machine, Harmonics(1)), 3750.0 * RPM, 4350.0 * RPM)


def eccentricity(machine: PlayedMachine) -> float:
    return machine.journals()["damper_1"].eccentricity_max


def test_tracked_machine_jumps_at_the_folds(curve: ResponseCurve) -> None:
    machine = TrackedMachine(curve, RUN)
    times = [0.05 * i for i in range(221)]
    found = []
    for time in times:
        assert machine.advance(time, EVER) == time
        found.append((RUN.speed(time) / RPM, eccentricity(machine)))
    steps = [
        (round(after[0]), after[1] - before[1])
        for before, after in pairwise(found)
        if abs(after[1] - before[1]) > 0.1
    ]
    (up, fall), (down, rise) = steps
    assert 4155 <= up <= 4170
    assert fall < -0.5
    assert 3980 <= down <= 3990
    assert rise > 0.1


@pytest.mark.parametrize("kind", [TrackedMachine, IntegratedMachine])
def test_a_machine_is_thrown_to_and_fro(curve: ResponseCurve, kind: type) -> None:
    machine = kind(curve, STEADY)
    machine.advance(0.5, EVER)
    upper = eccentricity(machine)
    thrown = machine.jump()
    machine.advance(1.0, EVER)
    lower = eccentricity(machine)
    assert thrown == f"thrown from eccentricity {upper:.3f} to {lower:.3f} at 4100 rpm"
    assert upper - lower > 0.4
    assert machine.jump().startswith(f"thrown from eccentricity {lower:.3f} to ")
    machine.advance(1.5, EVER)
    assert eccentricity(machine) == pytest.approx(upper, abs=1e-3)


@pytest.mark.parametrize("kind", [TrackedMachine, IntegratedMachine])
def test_where_there_is_one_response_there_is_no_other(curve: ResponseCurve, kind: type) -> None:
    machine = kind(curve, RUN)
    with pytest.raises(JumpError, match="there is no other stable response at 3800 rpm"):
        machine.jump()


def test_integration_settles_on_what_harmonic_balance_finds(curve: ResponseCurve) -> None:
    """From 3 800 to 3 900 rpm, and steady from there on, with the phase from the keyphasor."""
    profile = SpeedProfile(from_rpm=3800.0, to_rpm=3900.0, rpm_per_second=500.0, hold=100.0)
    machine = IntegratedMachine(curve, profile)
    assert machine.advance(1.5, EVER) == 1.5
    motion = machine.journals()["damper_1"]
    expected = solve(curve.balance, 3900.0 * RPM).journals["damper_1"]
    assert motion.coefficients / motion.clearance == pytest.approx(
        expected.coefficients / motion.clearance, abs=1e-3
    )


def test_integration_that_cannot_keep_up_says_how_far_it_got(curve: ResponseCurve) -> None:
    machine = IntegratedMachine(curve, STEADY)
    assert machine.advance(0.01, 0.0) == 0.01, "no revolution has ended yet"
    assert machine.advance(1.0, 0.0) == 0.0
    reached = machine.advance(1.0, 1e-6)
    assert reached == pytest.approx(60.0 / 4100.0, rel=1e-9), "one revolution"


def test_without_a_machine_nothing_is_measured() -> None:
    bare = BareSpeed()
    assert bare.advance(3.0, 0.0) == 3.0
    assert bare.journals() == {}
    with pytest.raises(JumpError, match="machine_file is empty"):
        bare.jump()
