"""Condensation through the shaft's modes against elimination, which knows no modes."""

import numpy as np
import pytest

from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.rotor import Condensation, assemble
from sfd_hbm_ros.rotor.modal_condensation import ShaftModes
from test.hbm.machines import PAPER, random_machine

ORDERS = np.arange(8.0)
MANY = 30  # evaluations in a row, after which modes are in use


def undamped(machine):
    """The machine without damping in its ball bearings."""
    names = [damper.name for damper in machine.dampers]
    return override_all(machine, {f"dampers.{name}.bearing_damping": 0.0 for name in names})


def with_modes(model, orders=ORDERS):
    """A condensation that has been asked often enough to use the shaft's modes."""
    condensation = Condensation(model)
    for _ in range(MANY):
        condensation.at(300.0, orders)
    return condensation


def parts(condensed):
    yield from (condensed.stiffness, condensed.stiffness_slope)
    yield from (condensed.force[..., np.newaxis], condensed.force_slope[..., np.newaxis])


@pytest.mark.parametrize("speed", [50.0, 200.0, 417.0, 800.0, 2000.0])
@pytest.mark.parametrize(
    "machine",
    [
        PAPER,
        undamped(random_machine(5, anisotropic=True, gravity=True)),
        undamped(random_machine(6, dampers=2, gravity=True)),
    ],
    ids=["paper", "anisotropic", "two dampers"],
)
def test_modes_equal_elimination(machine, speed, monkeypatch):
    model = assemble(machine)
    exact, modal = Condensation(model).at(speed, ORDERS), with_modes(model)
    used = []
    condense = ShaftModes.condense
    monkeypatch.setattr(
        ShaftModes, "condense", lambda *arguments: used.append(1) or condense(*arguments)
    )
    for one, other in zip(parts(exact), parts(modal.at(speed, ORDERS)), strict=True):
        error = np.linalg.norm(one - other, axis=(1, 2))
        assert np.all(error <= 1e-9 * np.linalg.norm(one, axis=(1, 2)))
    assert used == [1]


def test_damped_ball_bearing_is_eliminated():
    """Modes are those of an undamped shaft: with damping every answer stays the same."""
    machine = override_all(PAPER, {"dampers.damper_1.bearing_damping": 200.0})
    model = assemble(machine)
    once, often = Condensation(model).at(300.0, ORDERS), with_modes(model).at(300.0, ORDERS)
    assert once.stiffness.imag.any()
    assert np.array_equal(once.stiffness, often.stiffness)


def test_harmonic_on_a_mode_is_named():
    """A mass 1 on a spring 4 at the speed 2, all of whose numbers are exact."""
    stiffness, mass = np.array([[4.0, -4.0], [-4.0, 4.0]]), np.eye(2)
    terms = np.stack([stiffness, 0.0 * mass, 0.0 * mass, mass])[:, np.newaxis]
    orders = np.array([0.0, 1.0, 2.0])
    modes = ShaftModes(terms, np.zeros((2, 1, 2), dtype=complex), 1, orders)
    coefficients, factors = np.zeros((2, 3, 3)), np.zeros((2, 3, 2))
    *_, singular = modes.condense(2.0, coefficients, factors)
    assert orders[singular] == 1.0
    *_, singular = modes.condense(2.5, coefficients, factors)
    assert singular == -1
