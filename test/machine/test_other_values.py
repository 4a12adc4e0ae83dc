"""Integers, switches, words, matrices, vectors and names: what they may be."""

import math
from typing import Any

import pytest

from sfd_hbm_ros.machine import get, machine_from_dict

from .changes import changed, refusal

MATRIX = "or a matrix [[xx, xy], [yx, yy]] whose xx and yy are such"
STIFFNESS = f"a finite number [N/m] above 0, {MATRIX}"
DAMPING = f"a finite number [N s/m] of at least 0, {MATRIX}"
FORCE = "[x, y], each a finite number [N]"
NAME = "a name of at most 64 letters, digits, _ and -, with single spaces between"

BAD = [
    ("shaft.0.elements", 0, "an integer of at least 1", "0"),
    ("shaft.0.elements", 2.5, "an integer of at least 1", "2.5"),
    ("shaft.0.elements", "two", "an integer of at least 1", "'two'"),
    ("disks.disk_1.node", -1, "an integer of at least 0", "-1"),
    ("disks.disk_1.node", False, "an integer of at least 0", "false"),
    ("disks.disk_1.node", math.inf, "an integer of at least 0", "inf"),
    ("disks.disk_1.node", math.nan, "an integer of at least 0", "nan"),
    ("gravity", "maybe", "true or false", "'maybe'"),
    ("gravity", 1, "true or false", "1"),
    ("gravity", None, "true or false", "nothing"),
    ("dampers.damper_1.film.inertia", "y", "true or false", "'y'"),
    ("dampers.damper_1.film.model", "long", "one of: short", "'long'"),
    ("dampers.damper_1.film.model", ["short"], "one of: short", "['short']"),
    ("bearings.bearing_1.stiffness", 0, STIFFNESS, "0"),
    ("bearings.bearing_1.stiffness", [[1, 0], [0, -1]], STIFFNESS, "[[1, 0], [0, -1]]"),
    ("bearings.bearing_1.stiffness", [[1, "x"], [0, 1]], STIFFNESS, "[[1, 'x'], [0, 1]]"),
    ("bearings.bearing_1.stiffness", [[1, 0, 0], [0, 1]], STIFFNESS, "[[1, 0, 0], [0, 1]]"),
    ("bearings.bearing_1.stiffness", [1, 1], STIFFNESS, "[1, 1]"),
    ("bearings.bearing_1.stiffness", ["12", "34"], STIFFNESS, "['12', '34']"),
    ("bearings.bearing_1.damping", -1, DAMPING, "-1"),
    ("bearings.bearing_1.damping", [[0, 0], [0, -1]], DAMPING, "[[0, 0], [0, -1]]"),
    ("loads.disk_3.force", 9, FORCE, "9"),
    ("loads.disk_3.force", "12", FORCE, "12"),
    ("loads.disk_3.force", [0, 0, -9], FORCE, "[0, 0, -9]"),
    ("loads.disk_3.force", [0, "nan"], FORCE, "[0, 'nan']"),
    ("loads.disk_3.force", {1: 0, 2: 0}, FORCE, "{1: 0, 2: 0}"),
    ("name", 7, "one line of text", "7"),
    ("name", "a\nb", "one line of text", "'a\\nb'"),
]

GOOD = [
    ("gravity", True, True),
    ("gravity", "true", True),
    ("gravity", "on", True),
    ("gravity", "No", False),
    ("bearings.bearing_1.stiffness", "1.05e8", 1.05e8),
    ("bearings.bearing_1.stiffness", [[2, -1], ["3e0", 4]], [[2.0, -1.0], [3.0, 4.0]]),
    ("bearings.bearing_1.stiffness", [[2, 0], [0, 2]], 2.0),
    ("bearings.bearing_1.damping", 0, 0.0),
    ("bearings.bearing_1.damping", [[0, 5], [-5, 0]], [[0.0, 5.0], [-5.0, 0.0]]),
    ("loads.disk_3.force", ["1e2", -1], [100.0, -1.0]),
    ("name", "", ""),
    ("name", "Läufer Nr. 3: 40 % 'neu'", "Läufer Nr. 3: 40 % 'neu'"),
]

BAD_NAMES = ["disk.1", "", " disk", "a  b", "a=b", "a/b", "d" * 65, "disk\n", 7, True, None]
GOOD_NAMES = ["d", "7", "drive end-2", "Läufer", "on", "null", "1e3", "d" * 64]


@pytest.fixture
def data(paper_data: dict[str, Any]) -> dict[str, Any]:
    return changed(paper_data, "loads", [{"station": "disk_3", "force": [0, -100]}])


@pytest.mark.parametrize(("path", "value", "allowed", "shown"), BAD)
def test_bad_values_are_refused(
    data: dict[str, Any], path: str, value: object, allowed: str, shown: str
) -> None:
    sentence = refusal(changed(data, path, value))
    assert sentence == f"{path} must be {allowed}, not {shown}"


@pytest.mark.parametrize(("path", "value", "read"), GOOD)
def test_good_values_are_read(
    data: dict[str, Any], path: str, value: object, read: object
) -> None:
    machine = machine_from_dict(changed(data, path, value))
    assert get(machine, path) == read


def test_a_scalar_stands_for_a_diagonal_matrix(data: dict[str, Any]) -> None:
    bearing = machine_from_dict(data).bearings[0]
    assert bearing.stiffness == ((1.05e8, 0.0), (0.0, 1.05e8))
    assert bearing.damping == ((0.0, 0.0), (0.0, 0.0))


@pytest.mark.parametrize("name", BAD_NAMES)
def test_bad_names_are_refused(data: dict[str, Any], name: object) -> None:
    assert refusal(changed(data, "disks.disk_1.name", name)).startswith(
        f"disks.0.name must be {NAME}, not "
    )
    materials = {name: data["materials"]["steel"]}
    shaft = changed(data, "shaft.0.material", name)
    assert f".name must be {NAME}, not " in refusal(changed(shaft, "materials", materials))


@pytest.mark.parametrize("name", GOOD_NAMES)
def test_good_names_are_read(data: dict[str, Any], name: str) -> None:
    assert machine_from_dict(changed(data, "disks.disk_1.name", name)).stations[name] == 10
