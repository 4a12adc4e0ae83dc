"""Machines made by programs: the rules and sentences of the file, and values that stay put."""

import dataclasses
import pickle
from typing import Any

import numpy as np
import pytest

from sfd_hbm_ros.machine import (
    Bearing,
    Damper,
    Disk,
    FilmSettings,
    Load,
    Machine,
    MachineError,
    Material,
    ShaftSegment,
    Unbalance,
    machine_from_dict,
    machine_to_dict,
)

STEEL = Material("steel", 2.07e11, 7833.0, 0.3)
BRASS = Material("brass", 1.0e11, 8500.0, 0.34)

BAD_PARTS = [
    (Material, ("steel", -1.0, 7833.0, 0.3), "materials.steel.youngs_modulus must be a finite"),
    (ShaftSegment, (4, 0.1, 0.02, 0.03, STEEL), "shaft.inner_diameter must be below the outer"),
    (ShaftSegment, (4, 0.1, 0.02, 0.0, "steel"), "shaft.material must be a Material, not 'steel'"),
    (
        Disk,
        ("fan", 0, float("nan"), 0.0, 0.0),
        "disks.fan.mass must be a finite number [kg] above",
    ),
    (
        Bearing,
        ("left", 0, 0.0),
        "bearings.left.stiffness must be a finite number [N/m] above 0, or",
    ),
    (FilmSettings, ("long",), "film.model must be one of: short, not 'long'"),
    (Unbalance, ("fan", -1e-4), "unbalance.fan.magnitude must be a finite number [kg m] of at"),
    (
        Load,
        ("fan", (0.0,)),
        "loads.fan.force must be [x, y], each a finite number [N], not (0.0,)",
    ),
]


@pytest.mark.parametrize(("kind", "values", "sentence"), BAD_PARTS)
def test_bad_parts_are_refused(kind: type, values: tuple[Any, ...], sentence: str) -> None:
    with pytest.raises(MachineError) as error:
        kind(*values)
    assert str(error.value).startswith(sentence)


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("disks", [3.4], "disks must be a list of 0 or more Disk, not [3.4]"),
        ("dampers", None, "dampers must be a list of 0 or more Damper, not nothing"),
        ("shaft", (), "shaft must have 1 to 10000 elements, not 0"),
        ("materials", (BRASS,), "shaft.0.material must be one of the machine's materials brass"),
        ("materials", (STEEL, STEEL), "materials.steel must be given once, but there is"),
        (
            "bearings",
            (),
            "bearings and dampers must support the shaft at two nodes or more, not 1",
        ),
    ],
)
def test_parts_that_make_no_machine_are_refused(
    paper: Machine, key: str, value: object, sentence: str
) -> None:
    with pytest.raises(MachineError) as error:
        dataclasses.replace(paper, **{key: value})
    assert str(error.value).startswith(sentence)


def test_a_damper_is_checked_when_replaced(paper: Machine) -> None:
    with pytest.raises(MachineError, match=r"^dampers\.damper_1\.clearance must be below the"):
        dataclasses.replace(paper.dampers[0], clearance=0.04)
    with pytest.raises(
        MachineError, match=r"^dampers\.damper_1\.film must be a FilmSettings, not"
    ):
        dataclasses.replace(paper.dampers[0], film={"model": "short"})


def test_a_linear_rotor_has_no_dampers(paper: Machine) -> None:
    ball = Bearing("bearing_2", 24, 1.05e8)
    rotor = dataclasses.replace(paper, bearings=(*paper.bearings, ball), dampers=())
    assert rotor.stations["bearing_2"] == 24
    assert machine_from_dict(machine_to_dict(rotor)) == rotor


def test_values_take_their_fields_types() -> None:
    disk = Disk("fan", np.int64(3), np.float64(2.0), 1, 0)
    assert disk == Disk("fan", 3, 2.0, 1.0, 0.0)
    types = [type(getattr(disk, field.name)) for field in dataclasses.fields(disk)]
    assert types == [str, int, float, float, float]
    assert Load("fan", [1, 2]).force == (1.0, 2.0)
    assert Bearing("left", 0, 7, [[1, 2], [3, 4]]).damping == ((1.0, 2.0), (3.0, 4.0))


def test_machines_are_frozen_hashable_and_picklable(paper: Machine) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        paper.gravity = True  # type: ignore[misc]
    with pytest.raises(TypeError):
        paper.stations["fan"] = 3  # type: ignore[index]
    assert pickle.loads(pickle.dumps(paper)) == paper
    assert hash(dataclasses.replace(paper)) == hash(paper)


def test_an_error_keeps_its_sentence_between_processes() -> None:
    error = MachineError("is unknown", "mas", "disks.disk_1")
    assert str(pickle.loads(pickle.dumps(error))) == "disks.disk_1.mas is unknown"


def test_every_field_says_what_it_is() -> None:
    for kind in (Material, ShaftSegment, Disk, Bearing, FilmSettings, Damper, Unbalance, Load):
        assert list(kind.rules) == [field.name for field in dataclasses.fields(kind)]
    rule = Damper.rules["viscosity"]
    assert f"{rule.about}: {rule.allowed}" == (
        "oil's dynamic viscosity: a finite number [Pa s] above 0"
    )
