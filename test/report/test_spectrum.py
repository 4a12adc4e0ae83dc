"""Bars of spectra, against amplitudes in closed form."""

import numpy as np
import pytest

from sfd_hbm_ros.report.spectrum import draw_spectra, draw_spectrum
from sfd_hbm_ros.report.style import new_figure

from . import reading
from .curves import motion

#: Amplitudes of x: 1, 5, 0; of y: 7, 13, 2 um; the clearance is 100 um.
MOTION = motion(1e-6 * np.array([[-1.0, 7.0], [3.0, 5.0], [4.0, -12.0], [0.0, 0.0], [0.0, 2.0]]))


@pytest.fixture
def axes():
    return new_figure()[1][0]


def bars(axes):
    """Heights of the bars of each series, and their middles."""
    series = [container.patches for container in axes.containers]
    return (
        [[bar.get_height() for bar in one] for one in series],
        [[bar.get_x() + 0.5 * bar.get_width() for bar in one] for one in series],
    )


@pytest.mark.parametrize(
    ("micrometres", "unit", "label"),
    [(True, 1.0, "amplitude [µm, 0-pk]"), (False, 0.01, "amplitude [of clearance, 0-pk]")],
)
def test_amplitudes_of_both_directions(axes, micrometres, unit, label):
    draw_spectrum(axes, MOTION, micrometres=micrometres)
    heights, middles = bars(axes)
    assert np.allclose(heights, np.array([[1.0, 5.0, 0.0], [7.0, 13.0, 2.0]]) * unit)
    assert np.allclose(np.mean(middles, axis=0), [0.0, 1.0, 2.0])
    assert axes.get_ylabel() == label
    assert [text.get_text() for text in axes.get_xticklabels()] == ["0x", "1x", "2x"]
    assert reading.legend(axes) == ["$x$", "$y$"]


def test_several_motions_of_different_harmonics(axes):
    """A motion without an order has no bar there, and the others keep their places."""
    selected = motion(
        1e-6 * np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 6.0]]), highest=2, multiples=(0, 2)
    )
    draw_spectra(axes, {"all": MOTION, "selected": selected}, "y", micrometres=True)
    heights, middles = bars(axes)
    assert [pytest.approx(one) for one in heights] == [[7.0, 13.0, 2.0], [0.0, 6.0]]
    assert np.round(middles[1]).tolist() == [0.0, 2.0]
    assert axes.get_ylabel() == "amplitude of $y$ [µm, 0-pk]"
    assert reading.legend(axes) == ["all", "selected"]


def test_sub_harmonics_stand_between_the_orders(axes):
    half = motion(1e-6 * np.arange(10.0).reshape(5, 2), highest=1, revolutions=2)
    draw_spectrum(axes, half)
    _, middles = bars(axes)
    assert np.allclose(np.mean(middles, axis=0), [0.0, 0.5, 1.0])
    assert np.ptp(middles, axis=0).max() < 0.25  # bars of one order do not reach the next
    assert [text.get_text() for text in axes.get_xticklabels()] == ["0x", "1x"]


def test_logarithmic(axes):
    draw_spectrum(axes, MOTION, micrometres=True, logarithmic=True)
    assert axes.get_yscale() == "log"
    assert axes.get_ylim() == pytest.approx((13e-4, 26.0))
    assert bars(axes)[0][1] == pytest.approx([7.0, 13.0, 2.0])
