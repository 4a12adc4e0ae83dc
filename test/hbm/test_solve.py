"""What `solve` does beyond a plain Newton iteration: starts, ramps, and named failures."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, NewtonOptions, Outcome, solve
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import DEFAULTS
from sfd_hbm_ros.hbm.solve import first_guess, raise_load
from sfd_hbm_ros.machine import MachineError, override, read_machine

from .machines import PAPER, UNBEARABLE, random_machine

RPM = np.pi / 30.0


def balance_of(changes, harmonics=5):
    machine = PAPER
    for path, value in changes.items():
        machine = override(machine, path, value)
    return HarmonicBalance(machine, Harmonics(harmonics))


def test_start_selects_the_branch():
    """At 503.9 g mm the paper's rotor has two stable states near 4 040 rpm."""
    balance = balance_of({"unbalance.disk_2.magnitude": 5.039e-4})
    states = {}
    for name, speeds in {"up": (3900, 4040, 10), "down": (4300, 4040, -10)}.items():
        solution = None
        for rpm in range(speeds[0], speeds[1] + 1 if speeds[2] > 0 else speeds[1] - 1, speeds[2]):
            solution = solve(balance, rpm * RPM, start=solution)
            assert solution.converged
        states[name] = solution.journals["damper_1"].eccentricity_max
    assert states["up"] > states["down"] + 0.2


def test_start_near_the_solution_saves_iterations():
    balance = balance_of({})
    near = solve(balance, 3900 * RPM)
    assert (
        solve(balance, 3901 * RPM, start=near).iterations < solve(balance, 3901 * RPM).iterations
    )


def test_start_may_have_other_harmonics():
    few = solve(balance_of({"gravity": True}, harmonics=3), 3000 * RPM)
    many = solve(balance_of({"gravity": True}, harmonics=9), 3000 * RPM, start=few)
    assert many.converged
    assert many.iterations <= 3


def test_no_load_means_no_motion():
    machine = dataclasses.replace(PAPER, unbalance=())
    solution = solve(HarmonicBalance(machine, Harmonics(3)), 300.0)
    assert solution.converged
    assert not solution.coefficients.any()
    assert solution.journals["damper_1"].eccentricity_max == 0.0


def test_raising_the_load_ends_at_the_same_solution():
    balance = balance_of({"gravity": True, "dampers.damper_1.centering_stiffness": 2.627e5})
    direct = solve(balance, 3000 * RPM)
    raised, _ = raise_load(balance.at(3000 * RPM), DEFAULTS)
    assert raised.outcome is Outcome.CONVERGED
    assert raised.x == pytest.approx(direct.coefficients.ravel(), rel=1e-7, abs=1e-14)


def test_a_load_that_nothing_can_carry_is_named():
    """A film bears no steady load without motion, and the spring would need over the clearance."""
    solution = solve(balance_of(UNBEARABLE), 3000 * RPM)
    assert solution.outcome is Outcome.LOAD
    assert not solution.converged
    assert "beyond" in solution.message
    assert len(solution.residuals) >= 1
    assert np.isnan(solution.coefficients).all()
    assert np.isnan(solution.journals["damper_1"].eccentricity_max)


def test_iteration_limit_of_newton_is_named():
    equations = balance_of({}).at(3900 * RPM)
    result = newton(equations, first_guess(equations), NewtonOptions(iterations=1))
    assert result.outcome is Outcome.ITERATIONS
    assert len(result.residuals) == 2


@pytest.mark.parametrize("rpm", [3945, 3950])
def test_load_is_raised_where_newton_stalls(rpm):
    """Here the paper's rotor is at the threshold of jumping: almost a fold."""
    balance = balance_of({})
    equations = balance.at(rpm * RPM)
    assert newton(equations, first_guess(equations)).outcome is Outcome.STALLED
    solution = solve(balance, rpm * RPM)
    assert solution.converged
    assert solution.message.endswith("reached by raising the load")
    assert (
        np.linalg.norm(equations.residual(solution.coefficients.ravel())) < 1e-9 * equations.load
    )


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_speed_that_is_none_is_refused(speed):
    with pytest.raises(ValueError, match=r"speed: .* rad/s is not allowed"):
        solve(balance_of({}), speed)


def test_machine_without_damper_is_refused():
    machine = random_machine(1)
    [bearing] = machine.bearings
    other = dataclasses.replace(bearing, name="bearing_2", node=machine.nodes - 1)
    machine = dataclasses.replace(machine, bearings=(bearing, other), dampers=())
    with pytest.raises(MachineError, match="dampers must hold at least one"):
        HarmonicBalance(machine, Harmonics(3))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerance": 0.0}, r"tolerance: 0.0 .* \(0, 1\)"),
        ({"iterations": 0}, "iterations: 0"),
        ({"shortest_step": 1.0}, "shortest_step: 1.0"),
    ],
)
def test_options_out_of_range_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        NewtonOptions(**options)


def test_history_of_the_residual_falls():
    solution = solve(balance_of({}), 3900 * RPM)
    assert np.all(np.diff(solution.residuals) < 0)
    assert solution.residual == solution.residuals[-1] <= DEFAULTS.tolerance


def test_greatest_eccentricity_lies_between_the_time_samples():
    solution = solve(balance_of({"gravity": True}), 3000 * RPM)
    motion = solution.journals["damper_1"]
    fine = np.linalg.norm(motion.orbit(200_000), axis=1).max() / motion.clearance
    assert motion.eccentricity_max == pytest.approx(fine, rel=1e-9)
    assert motion.eccentricity_max >= fine


def test_twenty_solutions_in_a_row_where_the_shaft_s_vectors_run_out():
    """From the twentieth on they are in use; the response stays that of a fresh machine."""
    machine = read_machine(Path(__file__).parents[1] / "defects" / "D1_hang.json")
    balance = HarmonicBalance(machine, Harmonics(7))
    for rpm in range(9300, 9425, 5):
        solution = solve(balance, rpm * RPM)
    fresh = solve(HarmonicBalance(machine, Harmonics(7)), solution.speed)
    np.testing.assert_allclose(solution.coefficients, fresh.coefficients, rtol=1e-6, atol=1e-12)
