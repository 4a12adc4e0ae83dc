"""Condensation against a dense Schur complement, the full equations and closed forms."""

import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from sfd_hbm_ros.machine import Bearing, Disk, Material, ShaftSegment, Unbalance
from sfd_hbm_ros.rotor import Condensation, ResonanceError, assemble, partition

from .machines import RPM, paper_rotor, rich_rotor, rotor

ORDERS = np.array([0.0, 1.0 / 3.0, 0.5, 1.0, 2.0, 3.0, 7.0])
AXISYMMETRIC = ((2e7, 4e6), (-4e6, 2e7)), ((300.0, 25.0), (-25.0, 300.0))
ANISOTROPIC = ((2e7, 3e6), (-1e6, 1.5e7)), ((300.0, 20.0), (-40.0, 500.0))
MACHINES = {
    "paper": dataclasses.replace(paper_rotor(), gravity=True),
    "axisymmetric": rich_rotor(*AXISYMMETRIC),
    "anisotropic": rich_rotor(*ANISOTROPIC),
}
each_speed = pytest.mark.parametrize("speed", [50.0, 415.0, 1500.0])
each_machine = pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES.keys())


def dynamic_stiffness(model, speed, order):
    w = order * speed
    return model.K + 1j * w * (model.C + speed * model.G) - w**2 * model.M


def relative(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


@each_machine
@each_speed
def test_equals_the_dense_schur_complement(machine, speed):
    model = assemble(machine)
    condensed = Condensation(model).at(speed, ORDERS)
    forces = model.linear_force(speed, ORDERS)
    s = model.shaft_size
    for i, order in enumerate(ORDERS):
        P = dynamic_stiffness(model, speed, order)
        solved = np.linalg.solve(P[:s, :s], np.column_stack([P[:s, s:], forces[i, :s]]))
        reduced = P[s:, s:] - P[s:, :s] @ solved[:, :-1]
        force = forces[i, s:] - P[s:, :s] @ solved[:, -1]
        assert relative(condensed.stiffness[i], reduced) < 1e-10
        np.testing.assert_allclose(condensed.force[i], force, rtol=1e-9, atol=1e-300)


@each_machine
@each_speed
def test_recovered_response_fulfils_the_uncondensed_equations(machine, speed):
    """For any motion of the journals the shaft's equations hold, and the journals' lack a force
    that equals what the condensed equations lack."""
    model = assemble(machine)
    condensed = Condensation(model).at(speed, ORDERS)
    random = np.random.default_rng(7)
    shape = len(ORDERS), model.journals.size
    journals = 1e-4 * (random.standard_normal(shape) + 1j * random.standard_normal(shape))
    response = condensed.recover(journals)
    forces = model.linear_force(speed, ORDERS)
    s = model.shaft_size
    np.testing.assert_array_equal(response[:, s:], journals)
    for i, order in enumerate(ORDERS):
        P = dynamic_stiffness(model, speed, order)
        lack = P @ response[i] - forces[i]
        scale = np.abs(P) @ np.abs(response[i])
        assert np.all(np.abs(lack[:s]) <= 1e-13 * scale.max())
        expected = condensed.stiffness[i] @ journals[i] - condensed.force[i]
        np.testing.assert_allclose(lack[s:], expected, rtol=1e-7)


@pytest.mark.parametrize("name", ["paper", "axisymmetric"])
@each_speed
def test_forward_and_backward_whirl_agree_with_x_and_y(monkeypatch, name, speed):
    model = assemble(MACHINES[name])
    whirl = Condensation(model).at(speed, ORDERS)
    monkeypatch.setattr(partition, "is_axisymmetric", lambda model: False)
    cartesian = Condensation(model).at(speed, ORDERS)
    for i in range(len(ORDERS)):
        assert relative(whirl.stiffness[i], cartesian.stiffness[i]) < 1e-10
        np.testing.assert_allclose(whirl.force[i], cartesian.force[i], rtol=1e-9, atol=1e-300)
    journals = np.full((len(ORDERS), model.journals.size), 1e-5 + 2e-5j)
    assert relative(whirl.recover(journals), cartesian.recover(journals)) < 1e-10


@each_machine
@each_speed
def test_mean_is_real_and_rests_on_the_static_stiffness(machine, speed):
    """Harmonic 0 is the static equilibrium, whatever the speed."""
    model = assemble(machine)
    condensed = Condensation(model).at(speed, [0.0])
    assert not condensed.stiffness.imag.any()
    assert not condensed.force.imag.any()
    journals = np.linalg.solve(condensed.stiffness[0], condensed.force[0])
    static = np.linalg.solve(model.K, model.static_force)
    np.testing.assert_allclose(condensed.recover(journals[np.newaxis])[0], static, rtol=1e-8)


@each_speed
def test_unbalance_response_of_jeffcott_s_rotor(speed):
    """r = U W^2/(k + i W c - m W^2) at the disk, circular and forward; there are no dampers.

    The massless shaft gives way by 1e-8 of what the bearings do, tenfold near resonance.
    """
    mass, k, c, unbalance, phase = 12.0, 3e6, 400.0, 2e-4, 0.3
    ghost = Material("ghost", youngs_modulus=1e18, density=1e-6, poisson_ratio=0.3)
    damped = Bearing("left", 0, k / 2.0, c / 2.0), Bearing("right", 2, k / 2.0, c / 2.0)
    machine = rotor(
        shaft=(ShaftSegment(2, 0.25, 0.05, 0.0, ghost),),
        bearings=damped,
        disks=(Disk("disk", 1, mass, 0.1, 0.05),),
        unbalance=(Unbalance("disk", unbalance, phase),),
    )
    model = assemble(machine)
    response = Condensation(model).at(speed, [1.0]).recover(np.empty((1, 0)))
    x, y = response[0, model.stations["disk"]]
    expected = unbalance * np.exp(1j * phase) * speed**2 / (k + 1j * speed * c - mass * speed**2)
    assert x == pytest.approx(expected, rel=5e-7)
    assert y == pytest.approx(-1j * expected, rel=5e-7)


@pytest.mark.parametrize("is_axisymmetric", [True, False])
def test_harmonic_without_a_solution_is_named(monkeypatch, is_axisymmetric):
    """A shaft of no stiffness at all has none for harmonic 0 and one for the others."""
    model = assemble(paper_rotor())
    limp = dataclasses.replace(model, matrices=model.matrices._replace(K=0.0 * model.matrices.K))
    monkeypatch.setattr(partition, "is_axisymmetric", lambda model: is_axisymmetric)
    with pytest.raises(ResonanceError, match="harmonic 0 of the speed 300 rad/s") as error:
        Condensation(limp).at(300.0, [1.0, 2.0, 0.0])
    assert (error.value.order, error.value.speed) == (0.0, 300.0)


def exact_forward_stiffness(model, speed):
    """Eliminate the paper's shaft from K - W^2 (M - i G), x + i y forward, without rounding."""
    blocks = model.K[::2, ::2], model.M[::2, ::2], model.G[::2, 1::2]
    K, M, polar = (np.vectorize(Fraction, otypes=[object])(block) for block in blocks)
    P = K - Fraction(speed) ** 2 * (M - polar)
    for pivot in range(len(P) - 1):
        for row in range(pivot + 1, len(P)):
            if P[row, pivot]:
                P[row] -= P[row, pivot] / P[pivot, pivot] * P[pivot]
    return float(P[-1, -1])


@pytest.mark.parametrize("distance", [1e-2, 1e-4, 1e-6])
def test_condensed_stiffness_is_right_close_to_its_pole(distance):
    """Just above 4 162 rpm, where the paper's shaft resonates with its journal held.

    The module admits to a relative error of 1e-12 over the distance from the pole.
    """
    model = assemble(paper_rotor())
    speed = 4162.21514792694 * RPM * (1.0 + distance)
    [[xx, xy], _] = Condensation(model).at(speed, [1.0]).stiffness[0]
    exact = exact_forward_stiffness(model, speed)
    assert exact * distance == pytest.approx(3.1e5, rel=0.1)
    assert xx - 1j * xy == pytest.approx(exact, rel=1e-12 / distance)
