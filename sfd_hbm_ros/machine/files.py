"""Machines from files and plain data, and back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import yaml

from sfd_hbm_ros.machine.document import read_document
from sfd_hbm_ros.machine.errors import MachineError
from sfd_hbm_ros.machine.model import Machine
from sfd_hbm_ros.machine.parts import plain, read
from sfd_hbm_ros.machine.safe_file import FilePath


def read_machine(path: FilePath) -> Machine:
    """Return the machine of a YAML file, all values in SI units.

    `name`, `disks`, `bearings`, `unbalance`, `loads` and `gravity` may be left out, and so may
    `inner_diameter`, `damping`, `bearing_damping`, `film` and its keys, and `phase`.

    Raises
    ------
    MachineError
        If the file cannot be read or does not describe a machine; the sentence begins with the
        path.
    """
    try:
        return machine_from_dict(read_document(path))
    except MachineError as error:
        raise error.of(path) from None


def machine_from_dict(mapping: Mapping[str, Any]) -> Machine:
    """Return the machine of a mapping as it stands in a machine file.

    Raises
    ------
    MachineError
        If a key is unknown or missing, a value is not allowed, or there is no damper: a rotor
        without is for programs to make.
    """
    return read(Machine, mapping, "")


def machine_to_dict(machine: Machine) -> dict[str, Any]:
    """Return a machine as a new mapping of lists, text, floats, integers and booleans."""
    return plain(machine)


def write_machine(machine: Machine, path: FilePath) -> None:
    """Write a machine file, from which `read_machine` returns an equal machine.

    Raises
    ------
    MachineError
        If the file cannot be written.
    """
    text = yaml.dump(
        machine_to_dict(machine),
        Dumper=_Dumper,
        default_flow_style=None,
        sort_keys=False,
        allow_unicode=True,
        width=math.inf,
    )
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise MachineError(f"{path}: cannot be written: {reason}") from None


class _Dumper(yaml.SafeDumper):
    """A dumper that writes 2.07e+11 for what Python calls 207000000000.0."""


def _represent_float(dumper: yaml.SafeDumper, value: float) -> yaml.ScalarNode:
    """Return a number that is exact, and a number in YAML 1.1 as well as in 1.2."""
    if abs(value) < 1e6:
        return dumper.represent_float(value)
    text = np.format_float_scientific(value, trim="0")
    return dumper.represent_scalar("tag:yaml.org,2002:float", text)


_Dumper.add_representer(float, _represent_float)
