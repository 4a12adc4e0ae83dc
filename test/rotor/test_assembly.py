"""The assembled rotor: size, order of coordinates, masses, forces and symmetries."""

import dataclasses

import numpy as np
import pytest

from sfd_hbm_ros.machine import Unbalance
from sfd_hbm_ros.rotor import GRAVITY, assemble

from .machines import paper_rotor, rich_rotor

ANISOTROPIC = ((2e7, 3e6), (-1e6, 1.5e7)), ((300.0, 20.0), (-40.0, 500.0))


def shaft_mass(machine):
    return sum(
        segment.elements
        * segment.length
        * segment.material.density
        * np.pi
        / 4.0
        * (segment.outer_diameter**2 - segment.inner_diameter**2)
        for segment in machine.shaft
    )


def test_paper_rotor_has_100_coordinates_and_2_of_the_damper():
    model = assemble(paper_rotor())
    assert model.M.shape == model.C.shape == model.G.shape == model.K.shape == (102, 102)
    assert model.shaft_size == 100
    assert model.journals.tolist() == [[100, 101]]
    assert model.stations["disk_2"].tolist() == [48, 49]
    assert model.stations["damper_1"].tolist() == [96, 97]


def test_mass_stiffness_and_gyroscopic_matrices_have_their_symmetries():
    model = assemble(rich_rotor(2e7, 300.0))
    for matrix, transposed in (
        (model.M, model.M.T),
        (model.C, model.C.T),
        (model.K, model.K.T),
        (model.G, -model.G.T),
    ):
        np.testing.assert_allclose(matrix, transposed, rtol=0.0, atol=1e-15 * matrix.max())
    assert np.linalg.eigvalsh(model.M).min() > 0.0
    assert np.linalg.eigvalsh(model.K).min() > 0.0


def test_journal_is_tied_to_the_shaft_and_to_the_ground():
    machine = paper_rotor()
    [part] = machine.dampers
    model = assemble(machine)
    x, journal = model.stations["damper_1"][0], model.journals[0, 0]
    assert model.K[journal, journal] == part.bearing_stiffness + part.centering_stiffness
    assert model.K[x, journal] == model.K[journal, x] == -part.bearing_stiffness
    assert model.M[journal, journal] == part.journal_mass
    assert np.count_nonzero(model.K[journal]) == 2


def test_bearings_to_ground_enter_as_they_are_written():
    stiffness, damping = ANISOTROPIC
    without, model = assemble(rich_rotor(1.0, 0.0)), assemble(rich_rotor(*ANISOTROPIC))
    np.testing.assert_allclose((model.K - without.K)[:2, :2], stiffness - np.eye(2), rtol=1e-6)
    np.testing.assert_array_equal((model.C - without.C)[:2, :2], damping)
    assert not (model.K - without.K)[2:, 2:].any()


def test_disk_with_its_polar_inertia_turns_x_into_y():
    """Id b'' - i W Ip b' = moment for b = x' + i y': the text of the assembly module."""
    machine = paper_rotor()
    bare = dataclasses.replace(machine, disks=(), unbalance=())
    with_disks, without = assemble(machine), assemble(bare)
    node = machine.stations["disk_2"]
    rotations = slice(4 * node + 2, 4 * node + 4)
    polar, diametral = machine.disks[1].polar_inertia, machine.disks[1].diametral_inertia
    gyroscopic = (with_disks.G - without.G)[rotations, rotations]
    inertia = (with_disks.M - without.M)[rotations, rotations]
    np.testing.assert_allclose(gyroscopic, polar * np.array([[0.0, 1.0], [-1.0, 0.0]]), rtol=1e-9)
    np.testing.assert_allclose(inertia, diametral * np.eye(2), rtol=1e-9)


def test_weight_is_that_of_shaft_disks_and_journals_and_loads_come_on_top():
    machine = rich_rotor(2e7, 0.0)
    model = assemble(machine)
    mass = shaft_mass(machine)
    mass += sum(part.mass for part in machine.disks)
    mass += sum(part.journal_mass for part in machine.dampers)
    reactions = -model.K @ np.linalg.solve(model.K, model.static_force)
    deflections = np.zeros((2, model.size))
    for axis in range(2):
        deflections[axis, axis : model.shaft_size : 4] = 1.0
        deflections[axis, model.shaft_size + axis :: 2] = 1.0
    # Supports carry what remains of the internal forces under a rigid shift of the rotor.
    x_total, y_total = deflections @ -reactions
    assert x_total == pytest.approx(40.0 - 5.0, rel=1e-6)
    assert y_total == pytest.approx(-mass * GRAVITY - 90.0 + 3.0, rel=1e-9)
    np.testing.assert_allclose(deflections @ model.M @ deflections.T, mass * np.eye(2), atol=1e-9)


def test_no_weight_without_gravity():
    machine = dataclasses.replace(rich_rotor(2e7, 0.0), gravity=False)
    force = assemble(machine).static_force
    assert np.count_nonzero(force) == 4


def test_unbalance_pushes_as_the_design_says():
    """U W^2 (cos(W t + p), sin(W t + p)) at the station."""
    magnitude, phase, speed = 3e-4, 0.7, 250.0
    actions = (Unbalance("disk_3", magnitude, phase),)
    model = assemble(dataclasses.replace(paper_rotor(), unbalance=actions))
    static, first, second = model.linear_force(speed, [0, 1, 2])
    assert not static.any()
    assert not second.any()
    for time in (0.0, 1e-3, 5e-3):
        force = (first * np.exp(1j * speed * time)).real[model.stations["disk_3"]]
        angle = speed * time + phase
        expected = magnitude * speed**2 * np.array([np.cos(angle), np.sin(angle)])
        np.testing.assert_allclose(force, expected, rtol=1e-12)
    assert np.count_nonzero(first) == 2
