"""Orbits as drawn, against ellipses in closed form."""

import numpy as np
import pytest

from sfd_hbm_ros.report.orbit import draw_orbits
from sfd_hbm_ros.report.style import new_figure

from . import reading
from .curves import motion

#: x = 30 cos a + 40 sin a, y = -50 + 20 sin a, in um, with a clearance of 100 um.
ELLIPSE = motion(1e-6 * np.array([[0.0, -50.0], [30.0, 0.0], [40.0, 20.0]]))
SMALL = motion(1e-6 * np.array([[10.0, -80.0], [2.0, 0.0], [0.0, 1.0]]))


@pytest.fixture
def axes():
    return new_figure()[1][0]


def test_ellipse_in_the_clearance_circle(axes):
    draw_orbits(axes, {"ellipse": ELLIPSE})
    [line], [dot] = reading.curves(axes), reading.marks(axes, "o")
    x, y = line.get_xydata().T
    s = (y + 0.5) / 0.2  # sine of the rotor's angle
    assert np.allclose(s**2 + ((x - 0.4 * s) / 0.3) ** 2, 1.0)
    assert line.get_xydata()[-1] == pytest.approx(line.get_xydata()[0])
    assert dot == pytest.approx([0.3, -0.5])
    [circle] = axes.patches
    assert (circle.center, circle.radius) == ((0.0, 0.0), 1.0)
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim() == axes.get_ylim() == (-1.05, 1.05)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$x/c$ [-]", "$y/c$ [-]")


def test_runs_as_the_rotor_turns(axes):
    """A circle from the keyphasor on runs from x to y."""
    circle = motion(1e-6 * np.array([[0.0, 0.0], [50.0, 0.0], [0.0, 50.0]]))
    draw_orbits(axes, {"circle": circle})
    x, y = reading.curves(axes)[0].get_xydata().T
    assert np.allclose(np.diff(np.unwrap(np.arctan2(y, x))), 2.0 * np.pi / (len(x) - 1))


def test_several(axes):
    draw_orbits(axes, {"one": ELLIPSE, "two": SMALL})
    assert reading.legend(axes) == ["one", "two", "keyphasor, 0°"]
    assert reading.marks(axes, "o") == pytest.approx(np.array([[0.3, -0.5], [0.12, -0.8]]))
    one, two = reading.curves(axes)
    assert one.get_color() != two.get_color()


def test_close_up(axes):
    draw_orbits(axes, {"small": SMALL}, close_up=True)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert right - left == pytest.approx(high - low)
    assert 0.04 < right - left < 0.05
    assert (0.5 * (left + right), 0.5 * (low + high)) == pytest.approx((0.1, -0.8), abs=1e-6)


def test_two_revolutions(axes):
    """A sub-harmonic of a half has its own place at every other pulse of the keyphasor."""
    half = motion(
        1e-6 * np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0], [40.0, 0.0], [0.0, 40.0]]),
        highest=1,
        revolutions=2,
    )
    draw_orbits(axes, {"half": half})
    assert reading.marks(axes, "o") == pytest.approx(np.array([[0.5, 0.0], [0.3, 0.0]]))
    [line] = reading.curves(axes)
    assert line.get_xydata()[-1] == pytest.approx(line.get_xydata()[0])
