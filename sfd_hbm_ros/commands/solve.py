"""The response at one speed: eccentricity and harmonics of every damper."""

import argparse
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from sfd_hbm_ros.commands.arguments import (
    UsageError,
    add_harmonics,
    add_machine,
    harmonics_options,
    print_json,
    read_changed_machine,
    speed_from,
    truncation_sentence,
)
from sfd_hbm_ros.hbm import HarmonicBalance, JournalMotion, Solution, stability
from sfd_hbm_ros.hbm.solve import sag_sentences, static_sags
from sfd_hbm_ros.hbm.truncation import (
    AccurateSolution,
    HarmonicsOptions,
    solve_accurately,
    truncation_error,
)
from sfd_hbm_ros.report.units import length_text
from sfd_hbm_ros.response.curves.coexisting import coexisting_solutions
from sfd_hbm_ros.response.curves.peaks import greatest_of_disks
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.units import RPM

_SAME_RESPONSE = 0.05  # of the clearance, by which more harmonics may move a response


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument("--rpm", type=float, required=True, help="rotor speed [rpm]")
    parser.add_argument(
        "--near",
        type=float,
        metavar="ECCENTRICITY",
        help="of several responses at that speed the one whose greatest eccentricity is nearest",
    )
    add_harmonics(parser)


class _Response(NamedTuple):
    """A response with whether it is stable."""

    solution: Solution
    stable: bool


def run(chosen: argparse.Namespace) -> None:
    """Solve and print."""
    speed = speed_from(chosen.rpm)
    if chosen.near is not None and not 0.0 <= chosen.near < 1.0:
        raise UsageError(f"--near {chosen.near:g}: must be an eccentricity of at least 0, below 1")
    machine, options = read_changed_machine(chosen), harmonics_options(chosen.harmonics)
    found = solve_accurately(machine, speed, options)
    others = coexisting_solutions(
        found.balance, speed, found.solution if found.solution.converged else None
    )
    found, others = _choose(found, others, chosen.near, options)
    if not found.solution.converged:
        if chosen.json:
            print_json(_data(found, None, []))
        raise NoSolutionError(f"no solution at {chosen.rpm:g} rpm: {found.solution.message}")
    stable = stability(found.balance, found.solution).stable
    judged = [_Response(one, stability(found.balance, one).stable) for one in others]
    if chosen.json:
        print_json(_data(found, stable, judged))
    else:
        print(_text(found, stable, judged))


def _choose(
    found: AccurateSolution,
    others: list[Solution],
    near: float | None,
    options: HarmonicsOptions,
) -> tuple[AccurateSolution, list[Solution]]:
    """The response that is asked for, with enough harmonics, and the rest."""
    every = [found.solution, *others] if found.solution.converged else others
    if not every or (near is None and found.solution.converged):
        return found, others
    wanted = 0.0 if near is None else near
    best = min(every, key=lambda one: abs(one.eccentricity_max - wanted))
    if best is not found.solution:
        # more harmonics may lead to another response: then those that are there are enough
        start = AccurateSolution(found.balance, best, np.nan)
        more = solve_accurately(found.balance.machine, best.speed, options, start)
        kept = more.balance.harmonics.change_from(best.harmonics, best.coefficients)
        moved = np.abs(more.solution.coefficients - kept) / found.balance.clearances
        if not (more.solution.converged and moved.max() < _SAME_RESPONSE):
            more = start._replace(error=truncation_error(found.balance, best))
        found = more
    return found, [one for one in every if one is not best]


def _data(
    found: AccurateSolution, stable: bool | None, others: Sequence[_Response]
) -> dict[str, Any]:
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
        "greatest_vibration": _greatest(found.balance, solution),
        "sag": static_sags(found.balance),
        "others": [
            {
                "stable": other.stable,
                "eccentricity_max": other.solution.eccentricity_max,
                "dampers": {
                    name: _damper(motion) for name, motion in other.solution.journals.items()
                },
                "greatest_vibration": _greatest(found.balance, other.solution),
            }
            for other in others
        ],
    }


def _greatest(balance: HarmonicBalance, solution: Solution) -> dict[str, Any] | None:
    """The greatest vibration of any disk [m], zero to peak."""
    if not solution.converged:
        return None
    found = greatest_of_disks(balance, solution.speed, solution)
    return None if found is None else {"of": found.disk, "vibration": found.vibration}


def _damper(motion: JournalMotion) -> dict[str, Any]:
    (x_cos, y_cos), (x_sin, y_sin) = motion.cos.T.tolist(), motion.sin.T.tolist()
    return {
        "eccentricity_max": motion.eccentricity_max,
        "eccentricity_mean": motion.eccentricity_mean,
        "vibration": motion.vibration,
        "orders": motion.harmonics.orders.tolist(),
        "x_cos": x_cos,
        "x_sin": x_sin,
        "y_cos": y_cos,
        "y_sin": y_sin,
    }


def _text(found: AccurateSolution, stable: bool, others: Sequence[_Response]) -> str:
    """The same for people: amplitudes in micrometres, zero to peak."""
    solution = found.solution
    lines = [
        f"{solution.speed / RPM:g} rpm: {'stable' if stable else 'unstable'} response, "
        f"{solution.iterations} iterations, residual {solution.residual:.1e} of the load",
        truncation_sentence(solution.harmonics.highest, found.error),
        *_others_text(stable, others),
        *sag_sentences(found.balance),
    ]
    greatest = _greatest(found.balance, solution)
    if greatest is not None:
        lines.append(
            f"greatest vibration of any disk {length_text(greatest['vibration'])} zero to peak: "
            f"{greatest['of']}"
        )
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


def _others_text(stable: bool, others: Sequence[_Response]) -> Iterator[str]:
    """What else there is at the speed, and how to see it."""
    if not stable and any(other.stable for other in others):
        yield "the machine cannot stay on this response, as it is unstable"
    elif not stable:
        yield "no stable response was found at this speed: the machine cannot stay on any of these"
    if stable and any(other.stable for other in others):
        yield "bistable: which of the stable responses the machine is on depends on its history"
    for other in others:
        eccentricity = other.solution.eccentricity_max
        kind = "stable" if other.stable else "unstable"
        yield (
            f"another response, {kind}, has eccentricity {eccentricity:.4f}: "
            f"--near {eccentricity:.4f} shows it"
        )
