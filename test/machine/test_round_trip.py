"""Random machines are written and read back equal, to the last bit of every number."""

import contextlib
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

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
    read_machine,
    write_machine,
)
from sfd_hbm_ros.machine.document import parse

any_number = st.floats(-6e6, 6e6)
positive = st.floats(min_value=5e-324, max_value=1e3)
not_negative = st.floats(min_value=0.0, max_value=1e3)
size = st.floats(min_value=1e-9, max_value=1e3)
share = st.floats(min_value=0.0, max_value=0.999)
poisson_ratio = st.floats(min_value=-1.0, max_value=0.5, exclude_min=True, exclude_max=True)
words = st.text(
    st.characters(categories=["L", "Nd"], include_characters="_-"), min_size=1, max_size=12
)
names = words | st.sampled_from(["drive end", "null", "on", "1e3", "0x10", "1", "-", "true", "y"])
titles = st.text(st.characters(exclude_categories=["C", "Z"], include_characters=" "))
films = st.builds(FilmSettings, st.just("short"), st.booleans(), st.booleans())


def matrices(direct: st.SearchStrategy[float]) -> st.SearchStrategy[Any]:
    """Return scalars and 2x2 matrices with such direct terms."""
    return direct | st.tuples(st.tuples(direct, any_number), st.tuples(any_number, direct))


def segments(materials: list[Material]) -> st.SearchStrategy[ShaftSegment]:
    """Return solid and hollow shaft segments."""
    return st.builds(
        lambda elements, length, outer, ratio, material: ShaftSegment(
            elements, length, outer, ratio * outer, material
        ),
        st.integers(1, 9),
        positive,
        size,
        share,
        st.sampled_from(materials),
    )


def dampers(name: str, node: int) -> st.SearchStrategy[Damper]:
    """Return dampers whose clearance is below their radius."""
    return st.builds(
        lambda diameter, ratio, **others: Damper(
            name, node, diameter=diameter, clearance=ratio * diameter, **others
        ),
        size,
        st.floats(min_value=1e-6, max_value=0.499),
        bearing_stiffness=positive,
        bearing_damping=not_negative,
        journal_mass=positive,
        centering_stiffness=not_negative,
        length=positive,
        viscosity=positive,
        density=not_negative,
        film=films,
    )


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """Return machines whose first two stations are a bearing and a damper at the shaft's ends."""
    materials = [
        Material(name, draw(positive), draw(positive), draw(poisson_ratio))
        for name in draw(st.lists(names, min_size=1, max_size=3, unique=True))
    ]
    shaft = draw(st.lists(segments(materials), min_size=1, max_size=3))
    last = sum(segment.elements for segment in shaft)
    stations = draw(st.lists(names, min_size=2, max_size=6, unique=True))
    parts: dict[type, list[Any]] = {Bearing: [], Damper: [], Disk: []}
    for index, name in enumerate(stations):
        node = (0, last)[index] if index < 2 else draw(st.integers(0, last))
        kind = (Bearing, Damper)[index] if index < 2 else draw(st.sampled_from(list(parts)))
        values = {
            Bearing: st.builds(
                Bearing, st.just(name), st.just(node), matrices(positive), matrices(not_negative)
            ),
            Damper: dampers(name, node),
            Disk: st.builds(
                Disk, st.just(name), st.just(node), positive, not_negative, not_negative
            ),
        }
        parts[kind].append(draw(values[kind]))
    actions = st.lists(st.sampled_from(stations), unique=True, max_size=3)
    return Machine(
        name=draw(titles),
        materials=tuple(materials),
        shaft=tuple(shaft),
        disks=tuple(parts[Disk]),
        bearings=tuple(parts[Bearing]),
        dampers=tuple(parts[Damper]),
        unbalance=tuple(
            Unbalance(name, draw(not_negative), draw(any_number)) for name in draw(actions)
        ),
        loads=tuple(Load(name, (draw(any_number), draw(any_number))) for name in draw(actions)),
        gravity=draw(st.booleans()),
    )


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("machines") / "machine.yaml"


@settings(deadline=None)
@given(machine=machines())
def test_written_machines_are_read_back_equal(machine: Machine, path: Path) -> None:
    write_machine(machine, path)
    assert read_machine(path) == machine
    assert machine_from_dict(machine_to_dict(machine)) == machine
    # Other programs read the file by YAML 1.1's types, and must find the same numbers.
    assert yaml.safe_load(path.read_text(encoding="utf-8")) == machine_to_dict(machine)


@settings(deadline=None, max_examples=500)
@given(text=st.text(alphabet=st.sampled_from("ab: -[]{},&*!|>'\"%@#?\n\t\\U1~"), max_size=40))
def test_any_text_is_data_or_is_refused(text: str) -> None:
    with contextlib.suppress(MachineError):
        parse(text)


def test_a_written_file_looks_like_the_example(paper: Machine, path: Path) -> None:
    write_machine(paper, path)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[:7] == [
        "name: three-disk rotor, reconstructed from the reference paper",
        "materials:",
        "  steel: {youngs_modulus: 2.07e+11, density: 7833.0, poisson_ratio: 0.3}",
        "shaft:",
        "- {elements: 24, length: 0.0254, outer_diameter: 0.0319, inner_diameter: 0.0, "
        "material: steel}",
        "disks:",
        "- {name: disk_1, node: 10, mass: 3.4, polar_inertia: 0.0093, diametral_inertia: 0.00483}",
    ]
    assert "- {name: bearing_1, node: 0, stiffness: 1.05e+08, damping: 0.0}" in lines
    assert "  film: {model: short, cavitation: true, inertia: true}" in lines
    assert lines[-3:] == ["loads: []", "gravity: false", "operating_speed_rpm: []"]
