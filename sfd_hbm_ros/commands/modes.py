"""Critical speeds, or whirl modes at one speed, of the rotor with its films left out."""

import argparse
from typing import Any

from sfd_hbm_ros.commands.arguments import (
    UsageError,
    add_machine,
    print_json,
    read_changed_machine,
)
from sfd_hbm_ros.rotor import assemble, critical_speeds, whirl_modes
from sfd_hbm_ros.units import RPM


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument(
        "--rpm", type=float, help="rotor speed [rpm], 0 for the rotor at rest (else: criticals)"
    )


def run(chosen: argparse.Namespace) -> None:
    """Compute and print."""
    model = assemble(read_changed_machine(chosen))
    if chosen.rpm is None:
        criticals = [
            {"speed_rpm": critical.speed / RPM, "direction": critical.direction.value}
            for critical in critical_speeds(model)
        ]
        _print(chosen.json, {"critical_speeds": criticals}, criticals)
        return
    if not 0.0 <= chosen.rpm < float("inf"):
        raise UsageError(f"--rpm {chosen.rpm:g}: must be a finite speed of at least 0 rpm")
    modes = [
        {"frequency_rad_s": mode.frequency, "direction": mode.direction.value}
        for mode in whirl_modes(model, chosen.rpm * RPM)
    ]
    _print(chosen.json, {"speed_rpm": chosen.rpm, "modes": modes}, modes)


def _print(as_json: bool, data: Any, rows: list[dict[str, Any]]) -> None:
    """The whole as JSON, or its rows as a table with the first key as heading."""
    if as_json:
        print_json(data)
        return
    heading, sense = rows[0] if rows else ("", "")
    print(f"{heading:>18}  {sense}")
    for row in rows:
        print(f"{row[heading]:18.4f}  {row[sense]}")
