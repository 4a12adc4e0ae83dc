"""Critical speeds against the literature and closed forms."""

import numpy as np
import pytest

from sfd_hbm_ros.machine import Bearing, Disk, Material, ShaftSegment
from sfd_hbm_ros.rotor import Direction, assemble, critical_speeds, elements, whirl_modes

from .machines import RPM, paper_rotor, rotor
from .test_modes import ARM, DIAMETRAL, MASS, POLAR, rigid_rotor, two_disk_rotor

FORWARD, BACKWARD, PLANAR = Direction.FORWARD, Direction.BACKWARD, Direction.PLANAR


def overhung_rotor_of_1976():
    """Nelson and McVaugh, J. Eng. Ind. 98 (1976), 593: stations and radii in cm."""
    stations = [0.0, 1.27, 5.08, 7.62, 8.89, 10.16, 10.67, 11.43, 12.7, 13.46, 16.51, 19.05]
    stations += [22.86, 26.67, 28.7, 30.48, 31.5, 34.54, 35.5]
    outer = [0.51, 1.02, 0.76, 2.03, 2.03, 3.3, 3.3, 2.54, 2.54, 1.27, 1.27, 1.52, 1.52, 1.27]
    outer += [1.27, 3.81, 2.03, 2.03]
    inner = [0.0] * 6 + [1.52, 1.78] + [0.0] * 9 + [1.52]
    steel = Material("steel", youngs_modulus=2.078e11, density=7806.0, poisson_ratio=0.3)
    return rotor(
        shaft=tuple(
            ShaftSegment(1, length / 100.0, r_outer / 50.0, r_inner / 50.0, steel)
            for length, r_outer, r_inner in zip(np.diff(stations), outer, inner, strict=True)
        ),
        bearings=(Bearing("front", 10, 4.378e7), Bearing("rear", 14, 4.378e7)),
        disks=(Disk("disk", 4, 1.401, 2.03e-3, 1.36e-3),),
    )


def test_critical_speeds_of_the_overhung_rotor_of_nelson_and_mcvaugh(monkeypatch):
    """Nelson and McVaugh 1976, isotropic bearings, whirl ratios 1 and -1.

    Their element has rotary inertia and gyroscopic moments but no shear, which came with Nelson
    in 1980; so shear is made stiff here.
    """
    monkeypatch.setattr(elements, "shear_coefficient", lambda nu, ratio: 1e6)
    found = critical_speeds(assemble(overhung_rotor_of_1976()))[:6]
    expected = [15470.0, 17159.0, 46612.0, 49983.0, 64752.0, 96547.0]
    assert [critical.speed / RPM for critical in found] == pytest.approx(expected, rel=5e-3)
    assert [critical.direction for critical in found] == [BACKWARD, FORWARD] * 3


def test_shear_lowers_those_critical_speeds(monkeypatch):
    """By 0.5 to 1.5 %, which is why they cannot be met closely by a Timoshenko shaft."""
    model = assemble(overhung_rotor_of_1976())
    monkeypatch.setattr(elements, "shear_coefficient", lambda nu, ratio: 1e6)
    stiff_in_shear = assemble(overhung_rotor_of_1976())
    pairs = zip(critical_speeds(model)[:6], critical_speeds(stiff_in_shear)[:6], strict=True)
    lowered = [1.0 - with_shear.speed / without.speed for with_shear, without in pairs]
    assert min(lowered) > 0.005
    assert max(lowered) < 0.015


@pytest.mark.parametrize("polar", [0.0, 0.2, POLAR])
def test_critical_speeds_of_a_rigid_rotor(polar):
    """W^2 = 2 k/m, and 2 k a^2/(Id -+ Ip) forward and backward: none forward if Ip > Id."""
    k = 2e6
    bounce = np.sqrt(2.0 * k / MASS)
    backward = np.sqrt(2.0 * k * ARM**2 / (DIAMETRAL + polar))
    expected = [bounce, bounce, backward]
    if polar < DIAMETRAL:
        expected.append(np.sqrt(2.0 * k * ARM**2 / (DIAMETRAL - polar)))
    found = critical_speeds(assemble(rigid_rotor(k, polar=polar)))
    assert [critical.speed for critical in found] == pytest.approx(sorted(expected), rel=1e-7)


@pytest.mark.parametrize("stiffness", [1e6, ((1e6, 1e5), (1e5, 7e5))])
def test_at_a_critical_speed_a_mode_whirls_with_the_speed(stiffness):
    model = assemble(two_disk_rotor(6, stiffness))
    criticals = critical_speeds(model)
    assert len(criticals) >= 5
    for critical in criticals:
        nearest = min(
            whirl_modes(model, critical.speed),
            key=lambda mode: abs(mode.frequency - critical.speed),
        )
        assert nearest.frequency == pytest.approx(critical.speed, rel=1e-9)
        assert nearest.direction == critical.direction


def test_cross_coupling_that_feeds_a_whirl_does_not_move_critical_speeds():
    plain, fed = (
        critical_speeds(assemble(two_disk_rotor(6, ((1e6, q), (-q, 1e6))))) for q in (0.0, 2e5)
    )
    assert [c.speed for c in fed] == pytest.approx([c.speed for c in plain], rel=1e-9)


def test_critical_speeds_reach_to_ten_times_the_first():
    speeds = [critical.speed for critical in critical_speeds(assemble(paper_rotor()))]
    assert speeds == sorted(speeds)
    assert 5.0 * speeds[0] < speeds[-1] <= 10.0 * speeds[0]
