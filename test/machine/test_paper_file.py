"""The example file against the reference paper's numbers, converted here from their own units."""

from pathlib import Path
from typing import Any

import pytest

from sfd_hbm_ros.machine import (
    Bearing,
    Damper,
    Disk,
    FilmSettings,
    Machine,
    Material,
    ShaftSegment,
    Unbalance,
    machine_from_dict,
    read_machine,
)

INCH = 0.0254  # m, exact by definition
POUND_FORCE = 0.45359237 * 9.80665  # N, exact by definition

STEEL = Material("steel", 2.07e11, 7833.0, 0.3)
EXPECTED = Machine(
    name="three-disk rotor, reconstructed from the reference paper",
    materials=(STEEL,),
    shaft=(ShaftSegment(24, 0.0254, 0.0319, 0.0, STEEL),),
    disks=tuple(
        Disk(name, node, 3.4, 9.3e-3, 4.83e-3)
        for name, node in (("disk_1", 10), ("disk_2", 12), ("disk_3", 14))
    ),
    bearings=(Bearing("bearing_1", 0, ((1.05e8, 0.0), (0.0, 1.05e8))),),
    dampers=(
        Damper(
            name="damper_1",
            node=24,
            bearing_stiffness=1.05e8,
            bearing_damping=0.0,
            journal_mass=1.5,
            centering_stiffness=2.627e6,
            diameter=0.0762,
            length=0.0254,
            clearance=2.54e-4,
            viscosity=0.028,
            density=865.0,
            film=FilmSettings("short", cavitation=True, inertia=True),
        ),
    ),
    unbalance=(Unbalance("disk_2", 4.319e-4, 0.0),),
    loads=(),
    gravity=False,
)


def test_every_value_arrives_at_its_field(paper_file: Path) -> None:
    assert read_machine(paper_file) == EXPECTED
    assert read_machine(str(paper_file)) == EXPECTED


def test_a_plain_yaml_reader_gives_the_same_machine(paper_data: dict[str, Any]) -> None:
    # PyYAML's safe_load reads 2.07e11 as text, because YAML 1.1 wants a sign in the exponent.
    assert paper_data["materials"]["steel"]["youngs_modulus"] == "2.07e11"
    assert machine_from_dict(paper_data) == EXPECTED


def test_nodes_and_stations(paper: Machine) -> None:
    assert paper.nodes == 25
    assert paper.stations == {
        "disk_1": 10,
        "disk_2": 12,
        "disk_3": 14,
        "bearing_1": 0,
        "damper_1": 24,
    }


def test_values_are_the_papers_in_its_own_units(paper: Machine) -> None:
    damper = paper.dampers[0]
    assert damper.bearing_stiffness == pytest.approx(600e3 * POUND_FORCE / INCH, rel=1e-3)
    assert damper.centering_stiffness == pytest.approx(15e3 * POUND_FORCE / INCH, rel=1e-4)
    assert damper.diameter == pytest.approx(3.0 * INCH)
    assert damper.length == pytest.approx(1.0 * INCH)
    assert damper.clearance == pytest.approx(0.010 * INCH)
    assert paper.shaft[0].length == pytest.approx(1.0 * INCH)
    assert paper.unbalance[0].magnitude == pytest.approx(431.9e-6)  # 431.9 g mm
