"""Entries by their dotted paths, as the command line's --set and --vary name them."""

import dataclasses
from typing import Any

import pytest

from sfd_hbm_ros.machine import (
    Bearing,
    Load,
    Machine,
    MachineError,
    get,
    machine_to_dict,
    override,
    override_all,
)


@pytest.fixture
def machine(paper: Machine) -> Machine:
    """The paper's machine with a load, and a bearing that is a matrix."""
    bearing = Bearing("bearing_1", 0, ((1.0e8, 2.0e6), (-3.0e6, 1.1e8)))
    loads = (Load("disk_3", (0.0, -100.0)),)
    return dataclasses.replace(paper, bearings=(bearing,), loads=loads)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("name", "three-disk rotor, reconstructed from the reference paper"),
        ("gravity", False),
        ("materials.steel.density", 7833.0),
        ("shaft.0.outer_diameter", 0.0319),
        ("shaft.0.material", "steel"),
        ("disks.disk_2.node", 12),
        ("bearings.bearing_1.stiffness", [[1.0e8, 2.0e6], [-3.0e6, 1.1e8]]),
        ("bearings.bearing_1.stiffness.1.0", -3.0e6),
        ("bearings.bearing_1.damping", 0.0),
        ("dampers.damper_1.centering_stiffness", 2.627e6),
        ("dampers.damper_1.film", {"model": "short", "cavitation": True, "inertia": True}),
        ("dampers.damper_1.film.inertia", True),
        ("unbalance.disk_2.magnitude", 4.319e-4),
        ("unbalance.disk_1.magnitude", 0.0),
        ("unbalance.damper_1.phase", 0.0),
        ("loads.disk_3.force", [0.0, -100.0]),
        ("loads.disk_3.force.1", -100.0),
    ],
)
def test_get_and_put_back(machine: Machine, path: str, value: object) -> None:
    assert get(machine, path) == value
    assert override(machine, path, value) == machine


def test_overrides_of_the_design(machine: Machine) -> None:
    changed = override(machine, "dampers.damper_1.centering_stiffness", "1.7513e6")
    changed = override(changed, "unbalance.disk_2.magnitude", 5.039e-4)
    changed = override(changed, "gravity", "true")
    assert changed.dampers == (
        dataclasses.replace(machine.dampers[0], centering_stiffness=1.7513e6),
    )
    assert changed.unbalance[0].magnitude == 5.039e-4
    assert changed.gravity is True
    assert machine.gravity is False
    assert changed.shaft == machine.shaft


@pytest.mark.parametrize("station", ["disk_1", "bearing_1", "damper_1"])
def test_every_station_can_have_an_unbalance(machine: Machine, station: str) -> None:
    changes = {f"unbalance.{station}.magnitude": "2e-4", "unbalance.disk_2.phase": 1.0}
    kept, added = override_all(machine, changes).unbalance
    assert (added.station, added.magnitude, added.phase) == (station, 2e-4, 0.0)
    assert (kept.station, kept.magnitude, kept.phase) == ("disk_2", 4.319e-4, 1.0)
    with pytest.raises(MachineError, match=f"unbalance.{station}.magnitude must be a finite num"):
        override(machine, f"unbalance.{station}.magnitude", -1.0)


def test_a_material_changes_in_the_shaft_too(machine: Machine) -> None:
    changed = override(machine, "materials.steel.youngs_modulus", 2.0e11)
    assert changed.shaft[0].material.youngs_modulus == 2.0e11


def test_one_component_of_a_force(machine: Machine) -> None:
    assert override(machine, "loads.disk_3.force.1", -1600).loads[0].force == (0.0, -1600.0)


def test_whole_entries(machine: Machine) -> None:
    loads = [{"station": "damper_1", "force": [1, 2]}]
    assert override(machine, "loads", loads).loads == (Load("damper_1", (1.0, 2.0)),)
    film = {"model": "short", "inertia": False}
    assert override(machine, "dampers.damper_1.film", film).dampers[0].film.inertia is False


UNKNOWN = [
    ("", "'' is unknown; known here: name, materials, shaft, disks"),
    ("gravty", "gravty is unknown (did you mean gravity?); known here: name, materials"),
    ("gravity.x", "gravity.x is unknown; known here: nothing"),
    ("materials.stel", "materials.stel is unknown (did you mean steel?); known here: steel"),
    ("shaft.1.length", "shaft.1 is unknown; known here: 0"),
    ("shaft.steel", "shaft.steel is unknown; known here: 0"),
    (
        "disks.disk_9.mass",
        "disks.disk_9 is unknown (did you mean disk_3?); known here: disk_1, di",
    ),
    ("disks.0.mass", "disks.0 is unknown; known here: disk_1, disk_2, disk_3"),
    ("disks.disk_1.mas", "disks.disk_1.mas is unknown (did you mean mass?); known here: name, no"),
    ("disks.disk_1.", "disks.disk_1.'' is unknown; known here: name, node, mass"),
    ("dampers.damper_1.clearence", "dampers.damper_1.clearence is unknown (did you mean cleara"),
    ("unbalance.disk_9.magnitude", "unbalance.disk_9 is unknown (did you mean disk_3?); known "),
    ("unbalance.shaft.magnitude", "unbalance.shaft is unknown; known here: disk_2, disk_1, disk_"),
    ("unbalance.disk_1.mass", "unbalance.disk_1.mass is unknown; known here: station, magnitude"),
    ("loads.disk_3.force.2", "loads.disk_3.force.2 is unknown; known here: 0, 1"),
]


@pytest.mark.parametrize(("path", "sentence"), UNKNOWN)
def test_unknown_paths_say_what_there_is(machine: Machine, path: str, sentence: str) -> None:
    with pytest.raises(MachineError) as of_get:
        get(machine, path)
    with pytest.raises(MachineError) as of_override:
        override(machine, path, 1.0)
    assert str(of_get.value) == str(of_override.value)
    assert str(of_get.value).startswith(sentence)


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        ("dampers.damper_1.clearance", -1, "dampers.damper_1.clearance must be a finite number"),
        (
            "dampers.damper_1.clearance",
            1,
            "dampers.damper_1.clearance must be below the journal's",
        ),
        (
            "loads.disk_3.force.1",
            "down",
            "loads.disk_3.force must be [x, y], each a finite number",
        ),
        ("disks.disk_2.name", "fan", "unbalance.disk_2.station must be one of the stations"),
        ("shaft.0.elements", 12, "disks.disk_3.node must be a node of the shaft, 0 to 12, not 14"),
        ("gravity", None, "gravity must be true or false, not nothing"),
    ],
)
def test_bad_values_are_refused_as_in_a_file(
    machine: Machine, path: str, value: Any, sentence: str
) -> None:
    before = machine_to_dict(machine)
    with pytest.raises(MachineError) as error:
        override(machine, path, value)
    assert str(error.value).startswith(sentence)
    assert machine_to_dict(machine) == before


def test_entries_that_belong_together_change_together(machine: Machine) -> None:
    changes = {"shaft.0.elements": 48, "shaft.0.length": 0.0127, "dampers.damper_1.node": 48}
    finer = override_all(machine, changes)
    assert finer.nodes == 49
    assert finer.stations["damper_1"] == 48
    smaller = {"dampers.damper_1.diameter": 4e-4, "dampers.damper_1.clearance": 1e-4}
    assert override_all(machine, smaller).dampers[0].clearance == 1e-4
    with pytest.raises(MachineError, match="must be below the journal's radius"):
        override(machine, "dampers.damper_1.diameter", 4e-4)


def test_paths_are_those_before_any_change(machine: Machine) -> None:
    changes = {"unbalance.disk_2.station": "disk_1", "unbalance.disk_2.magnitude": 1e-4}
    [unbalance] = override_all(machine, changes).unbalance
    assert (unbalance.station, unbalance.magnitude) == ("disk_1", 1e-4)
