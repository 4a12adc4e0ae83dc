"""What the monitor reads of the predictor's messages."""

from __future__ import annotations

import math
from collections.abc import Iterator

from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState

from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages.common import named, read_stamp
from sfd_hbm_ros.node.monitor.run_warnings import JumpWarning

_SECOND = 1_000_000_000  # ns


def read_eccentricities(message: JointState) -> dict[str, tuple[float, float]]:
    """Return every damper's greatest eccentricity, and that on the other branch, NaN for none.

    Raises
    ------
    InputError
        If names and numbers do not pair.
    """
    greatest, other = {}, {}
    for name, value in named(message):
        match name.split("/"):
            case [damper, "max"]:
                greatest[damper] = value
            case [damper, "other_branch", "max"]:
                other[damper] = value
    return {damper: (value, other.get(damper, math.nan)) for damper, value in greatest.items()}


def read_x_amplitudes(message: JointState) -> dict[str, list[float]]:
    """Return the amplitudes of x of every damper from 1x on, zero to peak [m].

    Raises
    ------
    InputError
        If names and numbers do not pair.
    """
    amplitudes: dict[str, list[float]] = {}
    for name, value in named(message):
        match name.split("/"):
            case [damper, "x", _, "amplitude"]:
                amplitudes.setdefault(damper, []).append(value)
    return amplitudes


def read_diagnostics(message: DiagnosticArray, node: str) -> Iterator[tuple[str, int, str]]:
    """Yield name, level and message of every status of a node, whatever its namespace."""
    for status in message.status:
        if status.name.partition(": ")[0].rpartition("/")[2] == node:
            yield status.name, status.level[0], status.message


def read_warning(message: DiagnosticArray) -> JumpWarning:
    """Return the warning of a jump.

    Raises
    ------
    InputError
        If it lacks a value or one is no number.
    """
    stamp = read_stamp(message.header)
    try:
        (status,) = message.status
        values = {pair.key: pair.value for pair in status.values}
        return JumpWarning(
            stamp,
            status.level[0],
            status.message,
            values["next_jump"],
            float(values["next_jump_rpm"]),
            float(values["time_to_jump_s"]),
        )
    except (KeyError, ValueError) as error:
        raise InputError(f"it is no warning of a jump: {error}") from None
