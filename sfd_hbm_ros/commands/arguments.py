"""Arguments and conversions that the verbs share."""

import argparse
import json
import math
import sys
from collections.abc import Iterable
from typing import Any

from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.machine import Machine, MachineError, doubts, override_all, read_machine
from sfd_hbm_ros.machine.document import parse
from sfd_hbm_ros.units import RPM

MAX_HARMONICS = 100
"""Orders to 60 were needed at 0.99 of the clearance; a slip must not fill time and memory."""

_MOST_WARNINGS = 8  # at a time, as one slip may be repeated in every segment of a shaft


class UsageError(ValueError):
    """Arguments that cannot be, in one sentence."""


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
        "--harmonics",
        type=_highest,
        metavar="K",
        help="highest harmonic; by default as many, from 7 to 63, as keep the truncation error "
        "below 1e-5 of the clearance",
    )


def _highest(text: str) -> int:
    """A highest harmonic that is not beyond all reason; argparse says where it comes from."""
    if int(text) > MAX_HARMONICS:
        raise argparse.ArgumentTypeError(
            f"{text} is too many, it must be {MAX_HARMONICS} at most: the film excites none so "
            "high, and the work grows with the third power of their number"
        )
    return int(text)


def harmonics_options(highest: int | None, revolutions: int = 1) -> HarmonicsOptions:
    """How many harmonics are taken: as many as are needed, or those that were asked for."""
    if highest is None:
        return HarmonicsOptions(revolutions=revolutions)
    return HarmonicsOptions(fewest=highest, most=highest, revolutions=revolutions)


def truncation_sentence(highest: int, error: float) -> str:
    """What the harmonics that were left out would add; a cause for doubt is named."""
    if not math.isfinite(error):
        return f"{highest} harmonics; what more of them would add cannot be estimated"
    more = ", so more of them are needed" if error > HarmonicsOptions().tolerance else ""
    return f"{highest} harmonics; more would add {error:.0e} of the clearance{more}"


def read_changed_machine(chosen: argparse.Namespace) -> Machine:
    """The machine of the file with its overrides; what is odd about it goes to standard error."""
    changes = dict(_change(text) for text in chosen.changes)
    machine = read_machine(chosen.machine)
    machine = override_all(machine, changes) if changes else machine
    warn(doubts(machine))
    return machine


def warn(sentences: Iterable[str]) -> None:
    """Print warnings on standard error, which leave result and exit status alone."""
    every = list(sentences)
    more = [f"and {len(every) - _MOST_WARNINGS} more"] if len(every) > _MOST_WARNINGS else []
    for sentence in every[:_MOST_WARNINGS] + more:
        print(f"sfd_hbm: warning: {sentence}", file=sys.stderr)


def _change(text: str) -> tuple[str, Any]:
    """Path and value of PATH=VALUE; the value is read as in a machine file."""
    path, separator, value = text.partition("=")
    if not (path and separator):
        raise UsageError(f"--set {text}: must have the form PATH=VALUE")
    try:
        return path, parse(value)
    except MachineError as error:
        raise UsageError(f"--set {path}: {error}") from None


def speed_from(rpm: float, option: str = "--rpm") -> float:
    """Rotor speed [rad/s] of a value given in rpm.

    Raises
    ------
    UsageError
        If it is not finite and positive.
    """
    if not (math.isfinite(rpm) and rpm > 0.0):
        raise UsageError(f"{option} {rpm:g}: must be a finite speed above 0 rpm")
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
