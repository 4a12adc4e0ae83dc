"""Every number of a machine file: what it may be, and the sentence when it is not."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from sfd_hbm_ros.machine import Machine, get, machine_from_dict, machine_to_dict

from .changes import changed, refusal

NUMBERS = {
    "materials.steel.youngs_modulus": "a finite number [Pa] above 0",
    "materials.steel.density": "a finite number [kg/m3] above 0",
    "materials.steel.poisson_ratio": "a finite number above -1 and below 0.5",
    "shaft.0.length": "a finite number [m] above 0",
    "shaft.0.outer_diameter": "a finite number [m] above 0",
    "shaft.0.inner_diameter": "a finite number [m] of at least 0",
    "disks.disk_1.mass": "a finite number [kg] above 0",
    "disks.disk_1.polar_inertia": "a finite number [kg m2] of at least 0",
    "disks.disk_1.diametral_inertia": "a finite number [kg m2] of at least 0",
    "dampers.damper_1.bearing_stiffness": "a finite number [N/m] above 0",
    "dampers.damper_1.bearing_damping": "a finite number [N s/m] of at least 0",
    "dampers.damper_1.journal_mass": "a finite number [kg] above 0",
    "dampers.damper_1.centering_stiffness": "a finite number [N/m] of at least 0",
    "dampers.damper_1.diameter": "a finite number [m] above 0",
    "dampers.damper_1.length": "a finite number [m] above 0",
    "dampers.damper_1.clearance": "a finite number [m] above 0",
    "dampers.damper_1.viscosity": "a finite number [Pa s] above 0",
    "dampers.damper_1.density": "a finite number [kg/m3] of at least 0",
    "unbalance.disk_2.magnitude": "a finite number [kg m] of at least 0",
    "unbalance.disk_2.phase": "a finite number [rad]",
}

NO_NUMBERS = [
    (math.nan, "nan"),
    (-math.inf, "-inf"),
    (10**400, "100000000000000000...0000000000000000000"),
    ("9" * 400, "999999999999...9999999999999"),
    ("1e400", "1e400"),
    (".nan", "'.nan'"),
    ("abc", "'abc'"),
    ("1e", "'1e'"),
    ("1_000", "'1_000'"),
    ("0x10", "'0x10'"),
    ("1:30", "'1:30'"),  # ninety in YAML 1.1
    ("٣", "'٣'"),
    ("3.4 kg", "'3.4 kg'"),
    ("", "''"),
    (True, "true"),
    (None, "nothing"),
    ([3.4], "[3.4]"),
    ({"value": 3.4}, "{'value': 3.4}"),
]

OUT_OF_RANGE = [
    ("materials.steel.youngs_modulus", -2.07e11),
    ("materials.steel.density", 0),
    ("materials.steel.poisson_ratio", 0.5),
    ("materials.steel.poisson_ratio", -1),
    ("shaft.0.length", -0.0254),
    ("shaft.0.outer_diameter", 0.0),
    ("shaft.0.inner_diameter", -1e-300),
    ("disks.disk_1.mass", 0),
    ("disks.disk_1.mass", "1e-400"),
    ("disks.disk_1.polar_inertia", "-9.3e-3"),
    ("disks.disk_1.diametral_inertia", -1),
    ("dampers.damper_1.bearing_stiffness", 0),
    ("dampers.damper_1.bearing_damping", -1),
    ("dampers.damper_1.journal_mass", 0),
    ("dampers.damper_1.centering_stiffness", -1),
    ("dampers.damper_1.diameter", 0),
    ("dampers.damper_1.length", 0),
    ("dampers.damper_1.clearance", 0),
    ("dampers.damper_1.viscosity", 0),
    ("dampers.damper_1.density", -1),
    ("unbalance.disk_2.magnitude", -4.319e-4),
]

MEANINGLESS = [
    ("dampers.damper_1.viscosity", 1e300, "at most 2e+06 [Pa s]"),
    ("dampers.damper_1.centering_stiffness", 1e300, "at most 1e+18 [N/m]"),
    ("unbalance.disk_2.magnitude", 2e7, "at most 1e+07 [kg m]"),
    ("unbalance.disk_2.phase", -1e300, "at least -6.3e+06 [rad]"),
    ("loads", [{"station": "disk_3", "force": [0, -1e300]}], "at least -1e+13 [N]"),
    ("bearings.bearing_1.stiffness", 1e300, "at most 1e+19 [N/m]"),
    ("bearings.bearing_1.damping", [[0, 1e300], [0, 0]], "at most 1e+19 [N/m or N s/m]"),
]

ALLOWED = [
    ("shaft.0.inner_diameter", 0, 0.0),
    ("disks.disk_1.polar_inertia", 0, 0.0),
    ("disks.disk_1.diametral_inertia", 0, 0.0),
    ("dampers.damper_1.bearing_damping", 0, 0.0),
    ("dampers.damper_1.centering_stiffness", 0, 0.0),
    ("dampers.damper_1.density", 0, 0.0),
    ("unbalance.disk_2.magnitude", 0, 0.0),
    ("unbalance.disk_2.phase", -6e6, -6e6),
    ("materials.steel.poisson_ratio", 0.49999999999999994, 0.49999999999999994),
    ("materials.steel.poisson_ratio", -0.9999999999999999, -0.9999999999999999),
    ("disks.disk_1.mass", 5e-324, 5e-324),
    ("disks.disk_1.mass", "+3.e0", 3.0),
    ("disks.disk_1.mass", ".5E+1", 5.0),
    ("disks.disk_1.mass", "010", 10.0),  # eight in YAML 1.1
    ("disks.disk_1.mass", "340e-2", 3.4),
    ("disks.disk_1.node", 0, 0),
    ("disks.disk_1.node", "24", 24),
    ("disks.disk_1.node", 24.0, 24),
    ("shaft.0.elements", "2.5e1", 25),
]


def numeric_paths(data: Any, path: str = "") -> Iterator[str]:
    """Yield the path of every floating-point number in a machine's data."""
    if isinstance(data, float):
        yield path
    elif isinstance(data, (dict, list)):
        pairs = data.items() if isinstance(data, dict) else enumerate(data)
        for key, entry in pairs:
            label = (
                entry.get("name", entry.get("station", key)) if isinstance(entry, dict) else key
            )
            yield from numeric_paths(entry, f"{path}.{label}".lstrip("."))


def test_the_table_has_every_number(paper: Machine) -> None:
    others = {"bearings.bearing_1.stiffness", "bearings.bearing_1.damping"}  # maybe matrices
    disks = {path for path in NUMBERS if path.startswith("disks")}
    like_disk_1 = {path.replace("disk_1", f"disk_{i}") for path in disks for i in (2, 3)}
    assert set(numeric_paths(machine_to_dict(paper))) == NUMBERS.keys() | others | like_disk_1


@pytest.mark.parametrize(("value", "shown"), NO_NUMBERS)
@pytest.mark.parametrize(("path", "allowed"), NUMBERS.items())
def test_what_is_no_number_is_refused(
    paper_data: dict[str, Any], path: str, allowed: str, value: object, shown: str
) -> None:
    sentence = refusal(changed(paper_data, path, value))
    assert sentence == f"{path} must be {allowed}, not {shown}"


@pytest.mark.parametrize(("path", "value"), OUT_OF_RANGE)
def test_what_is_out_of_range_is_refused(
    paper_data: dict[str, Any], path: str, value: object
) -> None:
    sentence = refusal(changed(paper_data, path, value))
    assert sentence == f"{path} must be {NUMBERS[path]}, not {value}"


@pytest.mark.parametrize(("path", "value", "read"), ALLOWED)
def test_what_is_allowed_is_read_exactly(
    paper_data: dict[str, Any], path: str, value: object, read: float
) -> None:
    number = get(machine_from_dict(changed(paper_data, path, value)), path)
    assert number == read
    assert type(number) is type(read)


@pytest.mark.parametrize(("path", "value", "limit"), MEANINGLESS)
def test_what_no_unit_explains_is_refused(
    paper_data: dict[str, Any], path: str, value: object, limit: str
) -> None:
    sentence = refusal(changed(paper_data, path, value))
    key, _, problem = sentence.partition(" ")
    assert key == (path if path != "loads" else "loads.disk_3.force")
    assert problem.startswith(f"must be {limit}, a million times what is usual, not ")
