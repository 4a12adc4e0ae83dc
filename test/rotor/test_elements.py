"""The beam element against textbook matrices and the static Timoshenko beam."""

import numpy as np
import pytest

from sfd_hbm_ros.machine import Material, ShaftSegment
from sfd_hbm_ros.rotor.elements import beam_element, shear_coefficient

from .machines import STEEL

LENGTH = 0.3
HOLLOW = ShaftSegment(1, LENGTH, 0.08, 0.03, STEEL)
AREA = np.pi / 4.0 * (0.08**2 - 0.03**2)
SECOND_MOMENT = np.pi / 64.0 * (0.08**4 - 0.03**4)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_shear_coefficient_of_solid_and_thin_walled_sections(nu):
    """Cowper 1966, J. Appl. Mech. 33, table 1: circle and thin-walled round tube."""
    circle = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu)
    tube = 2.0 * (1.0 + nu) / (4.0 + 3.0 * nu)
    assert shear_coefficient(nu, 0.0) == pytest.approx(circle, rel=1e-15)
    assert shear_coefficient(nu, 1.0 - 1e-9) == pytest.approx(tube, rel=1e-8)


def test_slender_element_has_the_euler_bernoulli_matrices():
    """Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.5."""
    length, diameter = 1.0, 1e-4
    element = beam_element(ShaftSegment(1, length, diameter, 0.0, STEEL))
    rigidity = 2.11e11 * np.pi / 64.0 * diameter**4
    mass = 7810.0 * np.pi / 4.0 * diameter**2
    stiffness = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
    inertia = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    rotary = [[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]
    np.testing.assert_allclose(element.stiffness / rigidity, stiffness, rtol=1e-6)
    np.testing.assert_allclose(420.0 * element.mass / mass, inertia, rtol=1e-6)
    polar = 2.0 * 7810.0 * np.pi / 64.0 * diameter**4
    np.testing.assert_allclose(30.0 * element.gyroscopic / polar, rotary, rtol=1e-6)


def test_cantilever_bends_and_shears_under_a_load_and_a_moment_at_its_tip():
    """Timoshenko: v = P L^3/3EI + P L/kGA, r = P L^2/2EI; v = m L^2/2EI, r = m L/EI."""
    tip = np.linalg.inv(beam_element(HOLLOW).stiffness[2:, 2:])
    bending = 2.11e11 * SECOND_MOMENT
    shear = shear_coefficient(0.3, 0.03 / 0.08) * 2.11e11 / 2.6 * AREA
    cross = LENGTH**2 / (2.0 * bending)
    expected = [[LENGTH**3 / (3.0 * bending) + LENGTH / shear, cross], [cross, LENGTH / bending]]
    np.testing.assert_allclose(tip, expected, rtol=1e-12)


def test_rigid_motions_meet_no_stiffness_and_the_inertia_of_a_rigid_rod():
    element = beam_element(HOLLOW)
    shift, turn = np.array([1.0, 0.0, 1.0, 0.0]), np.array([-LENGTH / 2, 1.0, LENGTH / 2, 1.0])
    force = np.abs(element.stiffness) @ np.abs(turn)
    assert np.all(np.abs(element.stiffness @ shift) <= 1e-14 * force)
    assert np.all(np.abs(element.stiffness @ turn) <= 1e-14 * force)
    mass = 7810.0 * AREA * LENGTH
    diametral = 7810.0 * SECOND_MOMENT * LENGTH + mass * LENGTH**2 / 12.0
    polar = 2.0 * 7810.0 * SECOND_MOMENT * LENGTH
    assert shift @ element.mass @ shift == pytest.approx(mass, rel=1e-14)
    assert turn @ element.mass @ turn == pytest.approx(diametral, rel=1e-14)
    assert turn @ element.gyroscopic @ turn == pytest.approx(polar, rel=1e-14)
    assert shift @ element.gyroscopic @ shift == pytest.approx(0.0, abs=1e-14 * polar)


def test_short_element_keeps_its_shear_whatever_its_length():
    """A stack of very short elements shears like one: no locking."""
    material = Material("soft in shear", 2.0e11, 7800.0, 0.49)
    for length in (1e-4, 1e-2):
        tip = np.linalg.inv(
            beam_element(ShaftSegment(1, length, 0.1, 0.0, material)).stiffness[2:, 2:]
        )
        shear = shear_coefficient(0.49, 0.0) * 2.0e11 / 2.98 * np.pi / 4.0 * 0.1**2
        bending = 2.0e11 * np.pi / 64.0 * 0.1**4
        assert tip[0, 0] == pytest.approx(length / shear + length**3 / (3.0 * bending), rel=1e-9)
