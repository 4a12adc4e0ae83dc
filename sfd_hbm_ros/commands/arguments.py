"""Arguments and conversions that the verbs share."""

import argparse
import json
import math
from typing import Any

from sfd_hbm_ros.machine import Machine, MachineError, override_all, read_machine
from sfd_hbm_ros.machine.document import parse
from sfd_hbm_ros.units import RPM


def add_machine(parser: argparse.ArgumentParser) -> None:
    """Add the machine file and its overrides, and the form of the output."""
    parser.add_argument("machine", metavar="MACHINE", help="machine file (YAML)")
    parser.add_argument(
        "--set",
        dest="changes",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="override an entry, such as dampers.damper_1.centering_stiffness=1.75e6",
    )
    add_json(parser)


def add_json(parser: argparse.ArgumentParser) -> None:
    """Add the form of the output."""
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")


def add_harmonics(parser: argparse.ArgumentParser) -> None:
    """Add the number of harmonics."""
    parser.add_argument(
        "--harmonics", type=int, default=7, metavar="K", help="highest harmonic (default 7)"
    )


def read_changed_machine(chosen: argparse.Namespace) -> Machine:
    """The machine of the file with its overrides."""
    changes = dict(_change(text) for text in chosen.changes)
    machine = read_machine(chosen.machine)
    return override_all(machine, changes) if changes else machine


def _change(text: str) -> tuple[str, Any]:
    """Path and value of PATH=VALUE; the value is read as in a machine file."""
    path, separator, value = text.partition("=")
    if not (path and separator):
        raise ValueError(f"--set {text}: must have the form PATH=VALUE")
    try:
        return path, parse(value)
    except MachineError as error:
        raise ValueError(f"--set {path}: {error}") from None


def speed_from(rpm: float) -> float:
    """Rotor speed [rad/s] of a value given in rpm.

    Raises
    ------
    ValueError
        If it is not finite and positive.
    """
    if not (math.isfinite(rpm) and rpm > 0.0):
        raise ValueError(f"--rpm {rpm:g}: must be a finite speed above 0 rpm")
    return rpm * RPM


def print_json(data: Any) -> None:
    """Print one JSON object; what is not computable is null."""
    print(json.dumps(_finite(data), indent=2))


def _finite(data: Any) -> Any:
    """The same data with NaN and infinities, which JSON does not know, as None."""
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data
