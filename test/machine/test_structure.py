"""Keys, kinds, and what the parts of a machine must fulfil together."""

from typing import Any

import pytest

from sfd_hbm_ros.machine import get, machine_from_dict

from .changes import DELETED, changed, refusal

TOP = (
    "name, materials, shaft, disks, bearings, dampers, unbalance, loads, gravity, "
    "operating_speed_rpm"
)
DISK = "name, node, mass, polar_inertia, diametral_inertia"
STATIONS = "must be one of the stations disk_1, disk_2, disk_3, bearing_1, damper_1"
SUPPORT = "bearings and dampers must support the shaft at two nodes or more, not 1"

UNKNOWN = [
    ("damper", f"damper is unknown (did you mean dampers?); known here: {TOP}"),
    ("materials.steel.name", "known here: youngs_modulus, density, poisson_ratio"),
    ("shaft.0.diameter", "shaft.0.diameter is unknown (did you mean outer_diameter?); known"),
    ("disks.disk_1.mas", f"disks.disk_1.mas is unknown (did you mean mass?); known here: {DISK}"),
    ("dampers.damper_1.film.x", "dampers.damper_1.film.x is unknown; known here: model, cavi"),
    ("disks.disk_1.<<", f"disks.disk_1.<< is unknown; known here: {DISK}"),
    ("k" * 10_000, f"kkkkkkkkkkkk...kkkkkkkkkkkkk is unknown; known here: {TOP}"),
]

MISSING = [
    ("materials", "materials is missing: materials by name, a mapping of 1 or more names to"),
    ("shaft", "shaft is missing: segments from node 0, a list of 1 or more ShaftSegment"),
    ("shaft.0.material", "shaft.0.material is missing: material"),
    ("disks.disk_1.mass", "disks.disk_1.mass is missing: mass, a finite number [kg] above 0"),
    ("disks.disk_1.name", "disks.0.name is missing: name of the station, a name of at most 64"),
    ("bearings.bearing_1.stiffness", "bearings.bearing_1.stiffness is missing: stiffness, a fin"),
    ("dampers.damper_1.clearance", "dampers.damper_1.clearance is missing: radial clearance, a"),
    ("unbalance.disk_2.station", "unbalance.0.station is missing: name of a disk, bearing or"),
    ("unbalance.disk_2.magnitude", "unbalance.disk_2.magnitude is missing: mass times ecc"),
]

WRONG_KINDS = [
    ("materials", {}, "materials must be a mapping of 1 or more names to a Material, not {}"),
    ("materials", ["steel"], "materials must be a mapping of 1 or more names to a Material, not"),
    ("materials.steel", 2.0, "materials.steel must be a mapping with the keys youngs_modulus, "),
    ("shaft", [], "shaft must be a list of 1 or more ShaftSegment, not []"),
    ("shaft", None, "shaft must be a list of 1 or more ShaftSegment, not []"),
    ("shaft", {"elements": 24}, "shaft must be a list of mappings, not {'elements': 24}"),
    ("disks", "disk_1", "disks must be a list of mappings, not 'disk_1'"),
    ("disks.disk_1", "x", f"disks.0 must be a mapping with the keys {DISK}, not 'x'"),
    ("dampers.damper_1.film", "short", "dampers.damper_1.film must be a mapping with the keys"),
]

TOGETHER = [
    (
        "shaft.0.inner_diameter",
        0.0319,
        "shaft.0.inner_diameter must be below the outer diameter of 0.0319 m, not 0.0319",
    ),
    (
        "dampers.damper_1.clearance",
        0.0381,
        "dampers.damper_1.clearance must be below the journal's radius of 0.0381 m, not 0.0381",
    ),
    ("shaft.0.elements", 10**9, "shaft must have 1 to 10000 elements, not 1000000000"),
    ("disks.disk_1.node", 25, "disks.disk_1.node must be a node of the shaft, 0 to 24, not 25"),
    ("bearings.bearing_1.node", 25, "bearings.bearing_1.node must be a node of the shaft, 0 to"),
    ("dampers.damper_1.node", 99, "dampers.damper_1.node must be a node of the shaft, 0 to 24"),
    (
        "shaft.0.material",
        "stel",
        "shaft.0.material must be one of the materials steel, not 'stel' (did you mean steel?)",
    ),
    ("shaft.0.material", {"a": 1}, "shaft.0.material must be one of the materials steel, not"),
    (
        "unbalance.disk_2.station",
        "disk2",
        f"unbalance.disk2.station {STATIONS}, not 'disk2' (did you mean disk_2?)",
    ),
    ("loads", [{"station": "fan", "force": [0, 1]}], f"loads.fan.station {STATIONS}, not 'fan'"),
    (
        "disks.disk_1.name",
        "disk_2",
        "disks.disk_2 must be given once, but there is disks.disk_2 already",
    ),
    (
        "dampers.damper_1.name",
        "disk_1",
        "dampers.disk_1 must be given once, but there is disks.disk_1 already",
    ),
    ("unbalance", [{"station": "disk_1", "magnitude": 0}] * 2, "unbalance.disk_1 must be given"),
    ("loads", [{"station": "disk_1", "force": [0, 0]}] * 2, "loads.disk_1 must be given once"),
    ("bearings", [], SUPPORT),
    ("bearings.bearing_1.node", 24, SUPPORT),
]

LEFT_OUT = [
    ("name", ""),
    ("disks", []),
    ("unbalance", []),
    ("loads", []),
    ("gravity", False),
    ("shaft.0.inner_diameter", 0.0),
    ("bearings.bearing_1.damping", 0.0),
    ("dampers.damper_1.bearing_damping", 0.0),
    ("dampers.damper_1.film", {"model": "short", "cavitation": True, "inertia": True}),
    ("dampers.damper_1.film.inertia", True),
    ("unbalance.damper_1.phase", 0.0),
]


@pytest.mark.parametrize(("path", "sentence"), UNKNOWN)
def test_unknown_keys_are_refused(paper_data: dict[str, Any], path: str, sentence: str) -> None:
    assert sentence in refusal(changed(paper_data, path, 1))


@pytest.mark.parametrize("key", [3, None, ("a", "b")])
def test_keys_that_are_no_text_are_unknown(paper_data: dict[str, Any], key: object) -> None:
    assert refusal({**paper_data, key: 1}) == f"{key} is unknown; known here: {TOP}"


@pytest.mark.parametrize(("path", "sentence"), MISSING)
def test_missing_keys_are_refused(paper_data: dict[str, Any], path: str, sentence: str) -> None:
    assert refusal(changed(paper_data, path, DELETED)).startswith(sentence)


@pytest.mark.parametrize(("path", "value", "sentence"), WRONG_KINDS + TOGETHER)
def test_what_makes_no_machine_is_refused(
    paper_data: dict[str, Any], path: str, value: object, sentence: str
) -> None:
    assert refusal(changed(paper_data, path, value)).startswith(sentence)


@pytest.mark.parametrize("data", [None, [], "text", 3.0])
def test_what_is_no_mapping_is_refused(data: object) -> None:
    assert refusal(data).startswith(f"the machine must be a mapping with the keys {TOP}, not ")


@pytest.mark.parametrize(("path", "meaning"), LEFT_OUT)
def test_keys_that_may_be_left_out(paper_data: dict[str, Any], path: str, meaning: object) -> None:
    unbalance = [{"station": "damper_1", "magnitude": 1e-4, "phase": 1.0}]
    data = changed(paper_data, "unbalance", unbalance)
    assert get(machine_from_dict(changed(data, path, DELETED)), path) == meaning


@pytest.mark.parametrize("key", ["disks", "unbalance", "loads"])
def test_a_list_whose_items_are_all_commented_out_is_empty(
    paper_data: dict[str, Any], key: str
) -> None:
    data = changed(paper_data, "unbalance", [])
    assert get(machine_from_dict(changed(data, key, None)), key) == []


def test_bearings_may_be_left_out_where_dampers_support(paper_data: dict[str, Any]) -> None:
    second = {**paper_data["dampers"][0], "name": "damper_2", "node": 0}
    data = changed(paper_data, "dampers", [*paper_data["dampers"], second])
    machine = machine_from_dict(changed(data, "bearings", DELETED))
    assert machine.bearings == ()
    assert machine.stations["damper_2"] == 0


def test_stepped_hollow_shaft_of_two_materials_with_disks_at_one_node(
    paper_data: dict[str, Any],
) -> None:
    segment = paper_data["shaft"][0]
    titanium = {"youngs_modulus": 1.14e11, "density": 4430, "poisson_ratio": 0.34}
    hollow = {**segment, "elements": 3, "inner_diameter": 0.02, "material": "titanium"}
    data = changed(paper_data, "materials.titanium", titanium)
    data = changed(data, "shaft", [segment, hollow])
    machine = machine_from_dict(changed(data, "disks.disk_1.node", 12))
    assert machine.nodes == 24 + 3 + 1
    assert [part.material.name for part in machine.shaft] == ["steel", "titanium"]
    assert machine.shaft[1].inner_diameter == 0.02
    assert machine.stations["disk_1"] == machine.stations["disk_2"] == 12
