"""The shaft's receptance through Ritz vectors against elimination, which knows no modes."""

import dataclasses

import numpy as np
import pytest
from scipy.sparse import csr_array

from benchmarks.scaling import refined
from sfd_hbm_ros.machine import (
    Bearing,
    Disk,
    Load,
    Machine,
    ShaftSegment,
    Unbalance,
    override_all,
)
from sfd_hbm_ros.rotor import Condensation, ResonanceError, RotorModel, assemble, kept_modes
from sfd_hbm_ros.rotor.model import Matrices
from sfd_hbm_ros.rotor.partition import partition
from sfd_hbm_ros.rotor.shaft_modes import ShaftModes
from test.hbm.machines import PAPER, random_machine

from .machines import STEEL, damper, rich_rotor, rotor

ORDERS = np.arange(8.0)
MANY = 30  # evaluations in a row, after which modes are in use
TWO_DAMPERS = random_machine(6, dampers=2, gravity=True)
CROSS_COUPLED = rich_rotor(((2e7, 4e6), (-4e6, 2e7)), ((300.0, 25.0), (-25.0, 300.0)))
ANISOTROPIC = rich_rotor(((2e7, 3e6), (-1e6, 1.5e7)), ((300.0, 20.0), (-40.0, 500.0)))


def undamped(machine):
    """The machine without damping in its ball bearings."""
    names = [damper.name for damper in machine.dampers]
    return override_all(machine, {f"dampers.{name}.bearing_damping": 0.0 for name in names})


def with_modes(model, speed=1000.0, orders=ORDERS):
    """A condensation that has been asked often enough to use the shaft's modes."""
    condensation = Condensation(model)
    for _ in range(MANY):
        condensation.at(speed, orders)
    return condensation


def parts(condensed):
    yield from (condensed.stiffness, condensed.stiffness_slope)
    yield from (condensed.force[..., np.newaxis], condensed.force_slope[..., np.newaxis])


def assert_equal(one, other, tolerance):
    for a, b in zip(parts(one), parts(other), strict=True):
        error = np.linalg.norm(a - b, axis=(1, 2))
        assert np.all(error <= tolerance * np.linalg.norm(a, axis=(1, 2)))


@pytest.fixture
def uses(monkeypatch):
    """Whether each evaluation through modes had a result."""
    found = []
    receptance = ShaftModes.receptance

    def counted(*arguments):
        result = receptance(*arguments)
        found.append(result is not None)
        return result

    monkeypatch.setattr(ShaftModes, "receptance", counted)
    return found


@pytest.mark.parametrize("speed", [50.0, 200.0, 417.0, 800.0, 2000.0])
@pytest.mark.parametrize(
    "machine",
    [
        PAPER,
        undamped(random_machine(5, anisotropic=True, gravity=True)),
        undamped(TWO_DAMPERS),
        TWO_DAMPERS,
        CROSS_COUPLED,
        ANISOTROPIC,
    ],
    ids=["paper", "stiff in x", "two dampers", "damped ball bearings", "cross-coupled", "damped"],
)
def test_modes_equal_elimination(machine, speed, uses):
    model = assemble(machine)
    exact, condensation = Condensation(model).at(speed, ORDERS), with_modes(model)
    uses.clear()
    assert_equal(exact, condensation.at(speed, ORDERS), 1e-9)
    assert uses == [True]


@pytest.mark.parametrize("speed", [104.0, 416.0, 640.0])
def test_modes_equal_elimination_on_a_fine_mesh(speed, uses):
    """2 882 coordinates; elimination there rounds by 1e-8, by the fourth power of the mesh."""
    model = assemble(dataclasses.replace(refined(720), gravity=True))
    exact, condensation = Condensation(model).at(speed, ORDERS), with_modes(model, 700.0)
    uses.clear()
    assert_equal(exact, condensation.at(speed, ORDERS), 1e-7)
    assert uses == [True]


def test_number_of_vectors_does_not_grow_with_the_mesh():
    sizes = []
    for elements in (24, 240, 720):
        modes = ShaftModes(partition(assemble(refined(elements))), ORDERS, 1000.0)
        sizes.append(modes._values.shape[-1])
    assert max(sizes) <= min(sizes) + 1


def test_modes_serve_up_to_twice_the_speed_and_are_then_found_anew(uses):
    model = assemble(PAPER)
    condensation = with_modes(model, 300.0)
    [kept] = condensation._modes._kept.values()
    assert kept.highest == 600.0
    for speed in (599.0, 601.0, 1300.0):
        assert_equal(Condensation(model).at(speed, ORDERS), condensation.at(speed, ORDERS), 1e-9)
    [found_anew] = condensation._modes._kept.values()
    assert found_anew.highest == 2600.0


@pytest.mark.parametrize("distance", [1e-5, -1e-5])
def test_near_an_undamped_resonance_a_damped_shaft_is_eliminated(distance, uses):
    """The undamped shaft's receptance is lost in its own pole there."""
    machine = override_all(PAPER, {"dampers.damper_1.bearing_damping": 200.0})
    speed = 435.866151 * (1.0 + distance)  # the shaft with its journal held, 4 162 rpm
    model = assemble(machine)
    condensation = with_modes(model)
    uses.clear()
    found = condensation.at(speed, ORDERS)
    assert uses == [False]
    assert_equal(Condensation(model).at(speed, ORDERS), found, 1e-12)


def test_shaft_on_a_bearing_that_pushes_away_is_eliminated(uses):
    """Its stiffness has a negative eigenvalue, and so no Cholesky factor."""
    model = assemble(rich_rotor(((1e7, 5e7), (5e7, 1e7)), 0.0))
    found = with_modes(model).at(300.0, ORDERS)
    assert not uses
    assert_equal(Condensation(model).at(300.0, ORDERS), found, 1e-12)


def test_harmonic_on_a_mode_is_named(uses):
    """A mass 1 on a spring 4 at the speed 2, all of whose numbers are exact."""
    stiffness = csr_array(np.kron([[4.0, -4.0], [-4.0, 4.0]], np.eye(2)))
    mass = csr_array(np.eye(4))
    matrices = Matrices(M=mass, C=0.0 * mass, G=0.0 * mass, K=stiffness)
    nothing = np.zeros(4)
    model = RotorModel(matrices, np.array([[2, 3]]), {}, nothing.astype(complex), nothing)
    condensation = with_modes(model, 2.5, np.array([0.0, 1.0, 2.0]))
    uses.clear()
    with pytest.raises(ResonanceError, match="harmonic 1 of the speed 2 rad/s"):
        condensation.at(2.0, np.array([0.0, 1.0, 2.0]))
    assert uses == [False]


def few_elements(rng: np.random.Generator) -> Machine:
    """A random rotor of few coordinates on an anisotropic, damped bearing and a damper."""
    elements = int(rng.integers(2, 9))
    k, c = 10.0 ** rng.uniform(7.0, 8.3), 10.0 ** rng.uniform(1.0, 4.0)
    cross = k * rng.uniform(-0.1, 0.1)
    stiffness = (k, cross), (cross, k * rng.uniform(0.5, 1.5))
    damping = c if rng.random() < 0.5 else ((c, 0.0), (0.0, c * rng.uniform(0.5, 1.5)))
    ball_bearing = {
        "bearing_stiffness": 10.0 ** rng.uniform(7.0, 8.3),
        "bearing_damping": float(rng.choice([0.0, 200.0])),
    }
    return rotor(
        shaft=(ShaftSegment(elements, 0.6 / elements, rng.uniform(0.02, 0.06), 0.0, STEEL),),
        bearings=(Bearing("bearing", 0, stiffness, damping),),
        disks=(Disk("disk", int(rng.integers(elements + 1)), rng.uniform(1.0, 10.0), 0.01, 6e-3),),
        dampers=(damper("damper", elements, **ball_bearing),),
        unbalance=(Unbalance("disk", 1e-4),),
        loads=(Load("disk", (10.0, -50.0)),),
    )


def condensed_densely(model: RotorModel, speed: float, orders):
    """Stiffness and force of the journals, from the matrices of all coordinates."""
    w = (orders * speed)[:, np.newaxis, np.newaxis]
    P = model.K + 1j * w * (model.C + speed * model.G) - w**2 * model.M
    force = model.linear_force(speed, orders)[..., np.newaxis]
    s = model.shaft_size
    solved = np.linalg.solve(P[:, :s, :s], np.concatenate([P[:, :s, s:], force[:, :s]], axis=2))
    joined = np.concatenate([P[:, s:, s:], force[:, s:]], axis=2) - P[:, s:, :s] @ solved
    return joined[..., :-1], joined[..., -1]


def test_two_thousand_random_shafts_of_few_coordinates(monkeypatch):
    """Their spaces are exhausted before the responses are exact enough: one in 25 never ended."""
    monkeypatch.setattr(kept_modes, "_WORTHWHILE", 1)
    rng, orders = np.random.default_rng(1), np.arange(2.0)
    for _ in range(2000):
        model = assemble(few_elements(rng))
        condensation, highest = Condensation(model), rng.uniform(50.0, 2500.0)
        for speed in (highest, 0.4 * highest):
            found = condensation.at(speed, orders)
            stiffness, force = condensed_densely(model, speed, orders)
            assert np.abs(found.stiffness - stiffness).max() <= 1e-9 * np.abs(stiffness).max()
            applied = np.abs(model.linear_force(speed, orders)).max()
            largest = max(applied, np.abs(force).max())  # beside a resonance more than applied
            assert np.abs(found.force - force).max() <= 1e-9 * largest
