"""Whirl modes against textbook rotors and closed forms."""

import dataclasses

import numpy as np
import pytest

from sfd_hbm_ros.machine import Bearing, Disk, Material, ShaftSegment
from sfd_hbm_ros.rotor import Direction, assemble, campbell, modes, whirl_modes

from .machines import RPM, beam, damper, disk, rotor

FORWARD, BACKWARD, PLANAR = Direction.FORWARD, Direction.BACKWARD, Direction.PLANAR
FRISWELL_STEEL = Material("steel", 2.11e11, 7810.0, 2.11e11 / (2.0 * 8.12e10) - 1.0)


def two_disk_rotor(elements, stiffness):
    """Friswell et al. 2010, example 5.9.1: 1.5 m shaft of 50 mm, G = 81.2 GPa, two disks."""
    disks = (
        disk("left_disk", elements // 3, 0.28, 0.07),
        disk("right_disk", 2 * elements // 3, 0.35, 0.07),
    )
    return beam(elements, 1.5, 0.05, stiffness, FRISWELL_STEEL, disks=disks)


def overhung_rotor():
    """Friswell et al. 2010, example 5.9.9: the second bearing 1 m from the first."""
    return rotor(
        shaft=(ShaftSegment(6, 0.25, 0.05, 0.0, FRISWELL_STEEL),),
        bearings=(Bearing("left", 0, 1e7), Bearing("right", 4, 1e7)),
        disks=(disk("disk", 6, 0.35, 0.07),),
    )


TEXTBOOK = {
    "isotropic at rest": (two_disk_rotor(6, 1e6), 0.0, [86.66, 86.66, 274.31, 274.31, 716.78]),
    "isotropic": (two_disk_rotor(6, 1e6), 4000.0, [85.39, 87.80, 251.78, 294.71, 600.18]),
    "anisotropic at rest": (
        two_disk_rotor(6, ((1e6, 0.0), (0.0, 8e5))),
        0.0,
        [82.65, 86.66, 254.52, 274.31, 679.49],
    ),
    "anisotropic": (
        two_disk_rotor(6, ((1e6, 0.0), (0.0, 8e5))),
        4000.0,
        [82.33, 86.86, 239.64, 287.25, 583.49],
    ),
    "overhung at rest": (overhung_rotor(), 0.0, [90.14, 90.14, 630.73, 630.73, 830.43, 830.43]),
    "overhung": (overhung_rotor(), 4000.0, [76.19, 103.91, 565.99, 634.23, 647.75, 1174.2]),
}


@pytest.mark.parametrize(("machine", "rpm", "expected"), TEXTBOOK.values(), ids=TEXTBOOK.keys())
def test_frequencies_of_textbook_rotors(machine, rpm, expected):
    """Friswell et al. 2010, examples 5.9.1, 5.9.2 and 5.9.9, as quoted in ROSS's tests.

    The torsional mode at 650.41 rad/s that is listed with the first two is not among those of a
    lateral model.
    """
    found = whirl_modes(assemble(machine), rpm * RPM)[: len(expected)]
    assert [mode.frequency for mode in found] == pytest.approx(expected, rel=1e-3)
    senses = [BACKWARD, FORWARD] * 3 if rpm else [PLANAR] * 6
    assert [mode.direction for mode in found] == senses[: len(expected)]


MASS, POLAR, DIAMETRAL, ARM = 20.0, 0.9, 0.5, 0.25  # kg, kg m2, kg m2, m


def rigid_rotor(stiffness, damping=0.0, polar=POLAR):
    """A disk on two equal bearings; its massless shaft bends by 5e-8 of what these give way."""
    ghost = Material("ghost", youngs_modulus=1e18, density=1e-6, poisson_ratio=0.3)
    return rotor(
        shaft=(ShaftSegment(2, ARM, 0.05, 0.0, ghost),),
        bearings=(Bearing("left", 0, stiffness, damping), Bearing("right", 2, stiffness, damping)),
        disks=(Disk("disk", 1, MASS, polar, DIAMETRAL),),
    )


@pytest.mark.parametrize("speed", [0.0, 50.0, 400.0])
def test_conical_whirl_of_a_rigid_rotor_splits(speed):
    """Id w^2 - Ip W w - 2 k a^2 = 0 for b = exp(i w t), and w = sqrt(2 k/m) for the bounce."""
    k = 2e6
    half = POLAR * speed / (2.0 * DIAMETRAL)
    root = np.sqrt(half**2 + 2.0 * k * ARM**2 / DIAMETRAL)
    bounce = np.sqrt(2.0 * k / MASS)
    found = whirl_modes(assemble(rigid_rotor(k)), speed)[:4]
    expected = sorted(
        [(bounce, BACKWARD), (bounce, FORWARD), (root - half, BACKWARD), (root + half, FORWARD)]
    )
    assert [mode.frequency for mode in found] == pytest.approx([w for w, _ in expected], rel=1e-7)
    if speed:
        assert {(mode.direction, round(mode.frequency, 3)) for mode in found} == {
            (direction, round(w, 3)) for w, direction in expected
        }


def test_damping_lowers_the_frequency_and_ends_the_oscillation():
    """w = sqrt(2 k/m - (c/m)^2) for the bounce; the conical mode is overdamped and left out."""
    k, c = 2e6, 6000.0
    slow, fast = assemble(rigid_rotor(k, c)), assemble(rigid_rotor(k, 5.0 * c))
    bounce = np.sqrt(2.0 * k / MASS - (c / MASS) ** 2)
    assert [m.frequency for m in whirl_modes(slow, 0.0)[:2]] == pytest.approx(
        [bounce] * 2, rel=1e-7
    )
    assert whirl_modes(fast, 0.0)[0].frequency > 1e4


def test_anisotropic_path_agrees_with_the_axisymmetric_one(monkeypatch):
    model = assemble(dataclasses.replace(two_disk_rotor(6, 1e6), dampers=(damper("d", 3),)))
    expected = whirl_modes(model, 300.0)
    monkeypatch.setattr(modes, "is_axisymmetric", lambda model: False)
    found = whirl_modes(model, 300.0)
    assert len(found) == len(expected) == 30
    for mode, other in zip(found, expected, strict=True):
        assert mode.frequency == pytest.approx(other.frequency, rel=1e-9)
        assert mode.direction == other.direction


@pytest.mark.parametrize("cross", [0.0, 1e5])
def test_rotor_that_nothing_holds_has_no_mode_of_frequency_zero(cross):
    """A journal without centring spring swings freely about the other bearing at rest."""
    machine = rotor(
        shaft=(ShaftSegment(6, 0.25, 0.05, 0.0, FRISWELL_STEEL),),
        bearings=(Bearing("left", 0, ((1e7, cross), (cross, 1e7))),),
        dampers=(damper("right", 6, centering_stiffness=0.0),),
    )
    assert whirl_modes(assemble(machine), 0.0)[0].frequency > 100.0


def test_campbell_data_are_the_modes_at_each_speed():
    model = assemble(two_disk_rotor(6, 1e6))
    diagram = campbell(model, [0.0, 200.0, 400.0])
    assert diagram == [whirl_modes(model, speed) for speed in (0.0, 200.0, 400.0)]
    forward = [row[1].frequency for row in diagram]
    assert forward == sorted(forward)
