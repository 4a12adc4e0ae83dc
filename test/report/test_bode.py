"""Bode plots, against vibrations of known amplitude and lag."""

import numpy as np
import pytest

from sfd_hbm_ros.report.bode import draw_bode
from sfd_hbm_ros.report.style import new_figure

from . import reading
from .curves import DAMPER, RPM, jumping, made, motion, sagging


@pytest.fixture
def pair():
    return new_figure(2, share_x=True)[1]


def vibration(amplitude, lag):
    """x = amplitude cos(angle - lag) and y a quarter of a turn behind, [um] and [deg]."""
    x = amplitude * np.exp(-1j * np.radians(lag))
    y = -1j * x
    return motion(1e-6 * np.array([[9.0, 9.0], [x.real, y.real], [-x.imag, -y.imag]]))


def resonance():
    amplitudes, lags = [10.0, 40.0, 90.0, 50.0, 20.0], [5.0, 60.0, 120.0, 200.0, 330.0]
    motions = [vibration(a, lag) for a, lag in zip(amplitudes, lags, strict=True)]
    return made(np.arange(1000.0, 1500.0, 100.0) * RPM, motions), amplitudes, lags


@pytest.mark.parametrize(("axis", "behind"), [("x", 0.0), ("y", 90.0)])
@pytest.mark.parametrize(("peak_to_peak", "factor"), [(False, 1.0), (True, 2.0)])
def test_amplitude_and_lag(pair, axis, behind, peak_to_peak, factor):
    curve, amplitudes, lags = resonance()
    draw_bode(*pair, curve, DAMPER, axis, peak_to_peak)
    [amplitude], [phase] = (reading.drawn(axes) for axes in pair)
    speeds = np.arange(1000.0, 1500.0, 100.0)
    assert np.allclose(amplitude, np.column_stack([speeds, factor * np.array(amplitudes)]))
    assert np.allclose(phase, np.column_stack([speeds, np.array(lags) + behind]))
    unit = "pk-pk" if peak_to_peak else "0-pk"
    assert pair[0].get_ylabel() == f"1x amplitude of ${axis}$ [µm, {unit}]"
    assert pair[1].get_ylabel() == "phase lag [°]"
    assert pair[1].get_xlabel() == "speed [rpm]"


@pytest.mark.parametrize(("lag", "shown"), [(-40.0, -40.0), (-50.0, 310.0), (730.0, 10.0)])
def test_lag_begins_within_one_turn(pair, lag, shown):
    curve = made([100.0, 200.0], [vibration(10.0, lag), vibration(10.0, lag + 30.0)])
    draw_bode(*pair, curve, DAMPER)
    [phase] = reading.drawn(pair[1])
    assert phase[:, 1] == pytest.approx([shown, shown + 30.0])


def test_lag_grows_downwards(pair):
    draw_bode(*pair, resonance()[0], DAMPER)
    bottom, top = pair[1].get_ylim()
    assert bottom > top


def test_circular_orbit_is_the_eccentricity(pair):
    """Of an orbit about the centre the amplitude of 1x is the eccentricity times clearance.

    The quasi-periodic branch is left out.
    """
    draw_bode(*pair, jumping(), DAMPER)
    for points, branch in zip(reading.drawn(pair[0]), jumping().branches[:2], strict=True):
        assert points[:, 1] == pytest.approx(branch.eccentricity(DAMPER) * 254.0, rel=1e-9)
    assert reading.legend(pair[0]) == ["unstable"]


def test_unstable_is_dashed_in_both(pair):
    draw_bode(*pair, sagging(), DAMPER)
    for axes in pair:
        assert [reading.is_dashed(line) for line in reading.curves(axes)] == [False, True, False]


def test_passes_the_resonance(pair):
    """x lags by about nothing far below the critical speed and by about half a turn above it."""
    draw_bode(*pair, sagging(), DAMPER)
    [phase] = reading.drawn(pair[1])
    assert 0.0 < phase[0, 1] < 135.0 < phase[-1, 1] < 225.0
    assert np.abs(np.diff(phase[:, 1])).max() < 90.0
