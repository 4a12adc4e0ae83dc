"""Ranges A:B and entries PATH=A:B given on the command line."""

import math

from sfd_hbm_ros.commands.arguments import UsageError
from sfd_hbm_ros.machine import Machine, MachineError, get


def range_from(option: str, text: str) -> tuple[float, float]:
    """Both ends of A:B.

    Raises
    ------
    UsageError
        If the text is not two different finite numbers with a colon between.
    """
    try:
        start, end = (float(part) for part in text.split(":"))
    except ValueError:
        start = end = math.nan
    if not (math.isfinite(start) and math.isfinite(end) and start != end):
        raise UsageError(f"{option} {text}: must be A:B with two different finite numbers")
    return start, end


def varied_from(text: str, machine: Machine) -> tuple[str, float, float]:
    """Dotted path and both ends of PATH=A:B.

    Raises
    ------
    UsageError
        If the text has another form, or the entry is not a number.
    MachineError
        If there is no such entry.
    """
    path, _, ends = text.partition("=")
    start, end = range_from(f"--vary {path}", ends)
    check_number(machine, path)
    return path, start, end


def check_number(machine: Machine, path: str) -> None:
    """Check that there is an entry at a dotted path, and that it is a number.

    Raises
    ------
    MachineError
        If there is none, or it is not a number.
    """
    value = get(machine, path)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise MachineError("must be a number to vary", path)
