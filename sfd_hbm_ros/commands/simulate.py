"""A run-up or coast-down in time, which shows by itself where the machine jumps."""

import argparse
import math
import time
from typing import Any

import numpy as np

from sfd_hbm_ros.commands.arguments import (
    UsageError,
    add_harmonics,
    add_machine,
    harmonics_options,
    print_json,
    read_changed_machine,
)
from sfd_hbm_ros.commands.files import check_outputs
from sfd_hbm_ros.commands.progress import Progress, speed_bar
from sfd_hbm_ros.hbm.truncation import solve_accurately
from sfd_hbm_ros.report.transient_table import write_transient
from sfd_hbm_ros.response.integration.observed import ObservedJump, observed_jumps
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import Transient, simulate
from sfd_hbm_ros.units import RPM

_MOST_REVOLUTIONS = 1_000_000  # hours of computation


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument(
        "--from", dest="start", type=float, required=True, metavar="RPM", help="first speed [rpm]"
    )
    parser.add_argument(
        "--to", dest="end", type=float, required=True, metavar="RPM", help="last speed [rpm]"
    )
    parser.add_argument(
        "--rate", type=float, required=True, metavar="RPM_PER_S", help="rate of the speed [rpm/s]"
    )
    add_harmonics(parser)
    parser.add_argument("--output", metavar="F.csv", help="write the revolutions as CSV")
    parser.add_argument("--picture", metavar="F.png", help="draw the eccentricity over the speed")


def run(chosen: argparse.Namespace) -> None:
    """Simulate, and print what the run shows."""
    start = _positive("--from", chosen.start, "speed", "rpm")
    end = _positive("--to", chosen.end, "speed", "rpm")
    rate = _positive("--rate", chosen.rate, "rate", "rpm/s")
    if start == end:
        raise UsageError(f"--to {chosen.end:g}: must differ from --from {chosen.start:g} rpm")
    check_outputs(chosen)
    _check_length(Ramp.between(start, end, rate), chosen.rate)
    options = harmonics_options(chosen.harmonics)
    balance = solve_accurately(read_changed_machine(chosen), start, options).balance
    started = time.perf_counter()
    with Progress(speed_bar(start, end)) as progress:
        transient = simulate(balance, start, end, rate, progress=progress)
    seconds = time.perf_counter() - started
    jumps = observed_jumps(transient)
    if chosen.output:
        write_transient(transient, chosen.output)
    if chosen.picture:
        _draw(transient, jumps, chosen.picture)
    data = _data(transient, jumps, seconds)
    if chosen.json:
        print_json(data)
    else:
        print(_text(data))


def _positive(option: str, value: float, what: str, unit: str) -> float:
    """A speed [rad/s] or a rate [rad/s2] of a value given in rpm."""
    if not (math.isfinite(value) and value > 0.0):
        raise UsageError(f"{option} {value:g}: must be a finite {what} above 0 {unit}")
    return value * RPM


def _check_length(ramp: Ramp, rate: float) -> None:
    """Refuse a run of days."""
    if ramp.revolutions > _MOST_REVOLUTIONS:
        raise UsageError(
            f"--rate {rate:g}: must be faster, as the run would take {ramp.revolutions:.2g} "
            f"revolutions, and {_MOST_REVOLUTIONS:.0e} at most are computed"
        )


def _draw(transient: Transient, jumps: list[ObservedJump], path: str) -> None:
    """The eccentricities of every damper above one another, with the jumps."""
    from sfd_hbm_ros.report.style import new_figure, save  # matplotlib takes its time to import
    from sfd_hbm_ros.report.transient import draw_transient

    dampers = list(transient.eccentricity_max)
    figure, axes = new_figure(rows=len(dampers), size=(6.3, 3.7 * len(dampers)), share_x=True)
    for one, damper in zip(axes, dampers, strict=True):
        draw_transient(one, transient, damper, jumps)
        if len(dampers) > 1:
            one.set_title(damper)
    save(figure, path)


def _data(transient: Transient, jumps: list[ObservedJump], seconds: float) -> dict[str, Any]:
    eccentricity = transient.worst_eccentricity
    peak = int(eccentricity.argmax())
    return {
        "revolutions": transient.ramp.revolutions,
        "duration": float(transient.ramp.time(np.array([transient.ramp.revolutions]))[0]),
        "peak": {
            "speed_rpm": float(transient.speed[peak]) / RPM,
            "eccentricity": float(eccentricity[peak]),
        },
        "jumps": [
            {
                "direction": jump.direction.value,
                "speed_rpm": jump.speed / RPM,
                "eccentricity_from": jump.eccentricity_from,
                "eccentricity_to": jump.eccentricity_to,
            }
            for jump in jumps
        ],
        "seconds": seconds,
    }


def _text(data: dict[str, Any]) -> str:
    """The same for people."""
    peak = data["peak"]
    lines = [
        f"{data['revolutions']} revolutions, {data['duration']:.2f} s of the machine's time, "
        f"in {data['seconds']:.1f} s",
        f"peak {peak['speed_rpm']:10.2f} rpm: eccentricity {peak['eccentricity']:.4f}",
    ]
    lines += [
        f"jump {jump['speed_rpm']:10.2f} rpm: eccentricity {jump['eccentricity_from']:.4f} to "
        f"{jump['eccentricity_to']:.4f}"
        for jump in data["jumps"]
    ]
    return "\n".join(lines)
