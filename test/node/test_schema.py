"""The declared parameters: types, ranges, descriptions, and the file that explains them."""

import math

import pytest

pytest.importorskip("rclpy")

from sfd_hbm_ros.machine import get, read_machine
from sfd_hbm_ros.node.schema import SCHEMA, ParameterError, Spec, machine_schema

from .process import PAPER_ROTOR, ROOT, parameters_of

RATE = Spec("rate", 100.0, "messages a second", "Hz", 0.1, 1000.0)
ORDER = Spec("order", 7, "highest order", "", 1, 31)
FLAG = Spec("flag", True, "whether")
FREE = Spec("free", 1.0, "for the machine to judge")


@pytest.mark.parametrize(
    ("spec", "value"),
    [(RATE, 0.1), (RATE, 1000.0), (RATE, 50), (ORDER, 31), (FLAG, False), (FREE, -1e300)],
)
def test_allowed_values_keep_their_value_and_get_the_type(spec, value):
    converted = spec.convert(value)
    assert converted == value
    assert type(converted) is type(spec.default)


@pytest.mark.parametrize(
    ("spec", "value", "sentence"),
    [
        (RATE, 0.0, "rate must be a number from 0.1 to 1000 [Hz], not 0.0"),
        (RATE, math.nan, "rate must be a number from 0.1 to 1000 [Hz], not nan"),
        (RATE, math.inf, "rate must be a number from 0.1 to 1000 [Hz], not inf"),
        (RATE, True, "rate must be a number from 0.1 to 1000 [Hz], not true"),
        (RATE, "50", "rate must be a number from 0.1 to 1000 [Hz], not 50"),
        (RATE, [50.0], "rate must be a number from 0.1 to 1000 [Hz], not [50.0]"),
        (RATE, None, "rate must be a number from 0.1 to 1000 [Hz], not nothing"),
        (ORDER, 7.0, "order must be an integer from 1 to 31, not 7.0"),
        (ORDER, 32, "order must be an integer from 1 to 31, not 32"),
        (FLAG, 1, "flag must be true or false, not 1"),
    ],
)
def test_other_values_are_refused_with_a_sentence(spec, value, sentence):
    with pytest.raises(ParameterError) as refused:
        spec.convert(value)
    assert str(refused.value) == sentence


def test_descriptors_show_meaning_unit_and_range():
    rate, order = RATE.descriptor, ORDER.descriptor
    assert rate.description == "messages a second [Hz]"
    assert [(r.from_value, r.to_value) for r in rate.floating_point_range] == [(0.1, 1000.0)]
    assert [(r.from_value, r.to_value, r.step) for r in order.integer_range] == [(1, 31, 1)]
    assert not FLAG.descriptor.integer_range
    assert not FREE.descriptor.floating_point_range


def test_machine_values_go_by_their_place_in_the_machine_file():
    machine = read_machine(PAPER_ROTOR)
    specs = {spec.name: spec for spec in machine_schema(machine)}
    assert list(specs) == [
        "dampers.damper_1.viscosity",
        "dampers.damper_1.centering_stiffness",
        "unbalance.disk_2.magnitude",
        "unbalance.disk_2.phase",
        "gravity",
    ]
    assert {name: spec.default for name, spec in specs.items()} == {
        name: get(machine, name) for name in specs
    }
    assert "[Pa s]" in specs["dampers.damper_1.viscosity"].about


def test_the_parameter_file_holds_every_parameter_with_its_default():
    text = (ROOT / "config" / "predictor.yaml").read_text()
    given = parameters_of(ROOT / "config" / "predictor.yaml")
    assert given == {spec.name: spec.default for spec in SCHEMA}
    for spec in SCHEMA:
        if math.isfinite(spec.least):
            assert f"{spec.least:g} to {spec.most:g}" in text
