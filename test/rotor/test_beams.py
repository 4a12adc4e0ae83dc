"""Uniform shafts on rigid bearings against closed forms of the continuous Timoshenko beam."""

import numpy as np
import pytest

from sfd_hbm_ros.machine import Load
from sfd_hbm_ros.rotor import GRAVITY, Direction, assemble, whirl_modes
from sfd_hbm_ros.rotor.elements import shear_coefficient

from .machines import beam, disk

LENGTH = 1.2  # m


def pinned(elements, diameter, **actions):
    """A uniform shaft on bearings stiff enough to shift its frequencies by less than 1e-8."""
    bending = 2.11e11 * np.pi / 64.0 * diameter**4
    return beam(elements, LENGTH, diameter, 1e11 * bending / LENGTH**3, **actions)


def exact_frequencies(half_waves, diameter, speed=0.0):
    """Frequencies of v = sin(n pi z/L), r ~ cos(n pi z/L), positive forward, of least magnitude.

    The amplitudes V and R obey (k a^2 - m w^2) V = k a R and (B a^2 + k - J w^2 + 2 J W w) R =
    k a V, with a = n pi/L, shear stiffness k, bending stiffness B, mass m and rotary inertia J per
    length: Timoshenko's equations with the moment of the turning sections.
    """
    area, second_moment = np.pi / 4.0 * diameter**2, np.pi / 64.0 * diameter**4
    k = shear_coefficient(0.3, 0.0) * 2.11e11 / 2.6 * area
    m, J = 7810.0 * area, 7810.0 * second_moment
    a = half_waves * np.pi / LENGTH
    deflection = np.poly1d([-m, 0.0, k * a**2])
    rotation = np.poly1d([-J, 2.0 * J * speed, 2.11e11 * second_moment * a**2 + k])
    roots = (deflection * rotation - np.poly1d([(k * a) ** 2])).roots
    return sorted(roots.real, key=abs)[:2]


def test_slender_pinned_shaft_has_the_euler_bernoulli_frequencies():
    """w_n = (n pi/L)^2 sqrt(E I/(rho A)); e.g. Rao, Mechanical Vibrations, section 8.5."""
    diameter = 2e-3
    modes = whirl_modes(assemble(pinned(32, diameter)), 0.0)
    n = np.arange(1, 5)
    expected = (n * np.pi / LENGTH) ** 2 * np.sqrt(2.11e11 / 7810.0) * diameter / 4.0
    found = [mode.frequency for mode in modes[:8]]
    assert found == pytest.approx(np.repeat(expected, 2), rel=5e-5)
    assert {mode.direction for mode in modes} == {Direction.PLANAR}


@pytest.mark.parametrize("speed", [100.0, 3000.0])
def test_spinning_stout_shaft_has_the_frequencies_of_timoshenko(speed):
    diameter = 0.15
    exact = sorted((w for n in (1, 2, 3) for w in exact_frequencies(n, diameter, speed)), key=abs)
    coarse, fine = (whirl_modes(assemble(pinned(n, diameter)), speed)[:6] for n in (32, 64))
    for w, first, second in zip(exact, coarse, fine, strict=True):
        # The error falls with h^2, as the next test shows; so extrapolated it falls with h^4.
        extrapolated = (4.0 * second.frequency - first.frequency) / 3.0
        assert extrapolated == pytest.approx(abs(w), rel=1e-6)
        assert second.direction == (Direction.FORWARD if w > 0.0 else Direction.BACKWARD)


@pytest.mark.parametrize("half_waves", [1, 2])
@pytest.mark.parametrize(("diameter", "coarsest", "order"), [(2e-3, 4, 4.0), (0.2, 8, 2.0)])
def test_frequencies_converge_with_the_element_s_order(half_waves, diameter, coarsest, order):
    """From above, with h^4 where the shaft is slender and h^2 where it shears.

    The cubic deflection's error is of the order h^4. The element's shear, which is constant over
    its length, has one of h^2, but stores little of a slender shaft's energy.
    """
    elements = np.array([1, 2, 4]) * coarsest * half_waves
    exact = abs(exact_frequencies(half_waves, diameter)[0])
    modes = [whirl_modes(assemble(pinned(int(n), diameter)), 0.0) for n in elements]
    errors = np.array([mode[2 * half_waves - 1].frequency for mode in modes]) / exact - 1.0
    assert np.all(errors > 0.0)
    assert -np.polyfit(np.log(elements), np.log(errors), 1)[0] == pytest.approx(order, abs=0.1)


def test_shaft_sags_under_its_weight_and_a_load():
    """Timoshenko: 5 w L^4/384EI + w L^2/8kGA, and P L^3/48EI + P L/4kGA at midspan."""
    diameter, elements, load = 0.08, 8, 2000.0
    machine = pinned(
        elements,
        diameter,
        disks=(disk("middle", elements // 2, 0.05, 1e-12, bore=0.0),),
        loads=(Load("middle", (load, 0.0)),),
        gravity=True,
    )
    model = assemble(machine)
    x, y = np.linalg.solve(model.K, model.static_force)[model.stations["middle"]]
    area, second_moment = np.pi / 4.0 * diameter**2, np.pi / 64.0 * diameter**4
    bending = 2.11e11 * second_moment
    shear = shear_coefficient(0.3, 0.0) * 2.11e11 / 2.6 * area
    weight = 7810.0 * area * GRAVITY
    sag = 5.0 * weight * LENGTH**4 / (384.0 * bending) + weight * LENGTH**2 / (8.0 * shear)
    assert y == pytest.approx(-sag, rel=1e-6)
    bow = load * LENGTH**3 / (48.0 * bending) + load * LENGTH / (4.0 * shear)
    assert x == pytest.approx(bow, rel=1e-6)
