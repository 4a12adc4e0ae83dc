"""The response at one speed: eccentricity and harmonics of every damper."""

import argparse
from typing import Any

import numpy as np

from sfd_hbm_ros.commands.arguments import (
    add_harmonics,
    add_machine,
    harmonics_options,
    print_json,
    read_changed_machine,
    speed_from,
    truncation_sentence,
)
from sfd_hbm_ros.hbm import JournalMotion, stability
from sfd_hbm_ros.hbm.truncation import AccurateSolution, solve_accurately
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.units import RPM


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument("--rpm", type=float, required=True, help="rotor speed [rpm]")
    add_harmonics(parser)


def run(chosen: argparse.Namespace) -> None:
    """Solve and print."""
    speed = speed_from(chosen.rpm)
    found = solve_accurately(
        read_changed_machine(chosen), speed, harmonics_options(chosen.harmonics)
    )
    solution = found.solution
    stable = stability(found.balance, solution).stable if solution.converged else None
    if chosen.json:
        print_json(_data(found, stable))
    if not solution.converged:
        raise NoSolutionError(f"no solution at {chosen.rpm:g} rpm: {solution.message}")
    if not chosen.json:
        print(_text(found, stable))


def _data(found: AccurateSolution, stable: bool | None) -> dict[str, Any]:
    """The contract's JSON object, coefficients in metres."""
    solution = found.solution
    return {
        "speed_rpm": solution.speed / RPM,
        "converged": solution.converged,
        "residual": solution.residual,
        "iterations": solution.iterations,
        "stable": stable,
        "harmonics": solution.harmonics.highest,
        "truncation_error": found.error,
        "dampers": {name: _damper(motion) for name, motion in solution.journals.items()},
    }


def _damper(motion: JournalMotion) -> dict[str, Any]:
    (x_cos, y_cos), (x_sin, y_sin) = motion.cos.T.tolist(), motion.sin.T.tolist()
    return {
        "eccentricity_max": motion.eccentricity_max,
        "eccentricity_mean": motion.eccentricity_mean,
        "orders": motion.harmonics.orders.tolist(),
        "x_cos": x_cos,
        "x_sin": x_sin,
        "y_cos": y_cos,
        "y_sin": y_sin,
    }


def _text(found: AccurateSolution, stable: bool | None) -> str:
    """The same for people: amplitudes in micrometres, zero to peak."""
    solution = found.solution
    lines = [
        f"{solution.speed / RPM:g} rpm: {'stable' if stable else 'unstable'} response, "
        f"{solution.iterations} iterations, residual {solution.residual:.1e} of the load",
        truncation_sentence(solution.harmonics.highest, found.error),
    ]
    for name, motion in solution.journals.items():
        lines += [
            "",
            f"{name}: eccentricity max {motion.eccentricity_max:.4f}, "
            f"mean {motion.eccentricity_mean:.4f} of the clearance "
            f"of {1e6 * motion.clearance:g} um",
            "  order      x [um]      y [um]",
        ]
        amplitudes = 1e6 * np.hypot(motion.cos, motion.sin)
        amplitudes[0] = 1e6 * motion.cos[0]  # a mean has a sign
        rounded = np.round(amplitudes, 4) + 0.0  # no minus before a zero
        lines += [
            f"  {order:4d}x {x:11.4f} {y:11.4f}"
            for order, (x, y) in zip(motion.harmonics.orders, rounded, strict=True)
        ]
    return "\n".join(lines)
