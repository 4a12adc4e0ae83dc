"""Cascades: places and heights of their lines."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.report.cascade import draw_cascade
from sfd_hbm_ros.report.style import new_figure

from .curves import DAMPER, RPM, jumping, made, motion


@pytest.fixture
def axes():
    return new_figure()[1][0]


def stems(axes):
    """Frequency [Hz], speed [rpm] and height [rpm] of each vertical line, the scale's last."""
    segments = [segment for lines in axes.collections for segment in lines.get_segments()]
    return np.array([[a[0], a[1], b[1] - a[1]] for a, b in segments if a[0] == b[0]])


def wave(*amplitudes):
    """A motion with amplitudes of x from 1x on [um], and none of y."""
    rows = np.zeros((2 * len(amplitudes) + 1, 2))
    rows[2::2, 0] = amplitudes
    rows[0] = 50.0  # a mean, which no cascade shows
    return motion(1e-6 * rows)


def test_heights_are_amplitudes(axes):
    speeds = np.linspace(1000.0, 2000.0, 5)
    first, second = np.array([10.0, 30.0, 80.0, 40.0, 20.0]), np.array([1.0, 2.0, 3.0, 9.0, 4.0])
    curve = made(speeds * RPM, [wave(a, b, 0.5) for a, b in zip(first, second, strict=True)])
    draw_cascade(axes, curve, DAMPER)
    *lines, scale = stems(axes)
    height = scale[2] / 40.0  # of one micrometre
    assert axes.texts[-1].get_text() == "40 µm of $x$, 0-pk"
    expected = [
        [order * speed / 60.0, speed, amplitude * height]
        for order, amplitudes in ((1, first), (2, second))  # 3x is too small to be seen
        for speed, amplitude in zip(speeds, amplitudes, strict=True)
    ]
    assert np.allclose(lines, expected)
    assert height * 80.0 == pytest.approx(150.0)
    assert [text.get_text() for text in axes.texts[:-1]] == ["1x", "2x"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("frequency [Hz]", "speed [rpm]")


def test_shows_a_run_up(axes):
    """Up to where the branch of the run-up loses stability, and behind the quasi-periodic one."""
    draw_cascade(axes, jumping(), DAMPER)
    up, down, quasi_periodic = jumping().branches
    lost = up.speed[up.stable].max() / RPM
    lines = stems(axes)[:-1]
    first = lines[np.isclose(lines[:, 0], lines[:, 1] / 60.0)]
    speed, height = first[:, 1], first[:, 2]
    assert np.all(np.diff(speed) > 0.0)
    [jump] = np.flatnonzero(np.diff(height) < 0.0)[:1]
    assert speed[jump] <= lost < speed[jump + 1]
    stable = np.concatenate([branch.speed[branch.stable] / RPM for branch in (up, down)])
    assert np.isin(speed.round(9), stable.round(9)).all()
    assert speed[jump + 1] > quasi_periodic.speed.max() / RPM


def test_at_most_forty_spectra(axes):
    speeds = np.linspace(1000.0, 2000.0, 200)
    draw_cascade(axes, made(speeds * RPM, [wave(10.0)] * 200), DAMPER)
    lines = stems(axes)[:-1]
    assert 30 <= len(lines) <= 41
    assert np.diff(lines[:, 1]).min() >= 25.0


def test_unstable_points_are_left_out(axes):
    kinds = (None, None, Instability.NEIMARK_SACKER, None, None)
    speeds = np.linspace(1000.0, 2000.0, 5)
    draw_cascade(axes, made(speeds * RPM, [wave(10.0)] * 5, kinds), DAMPER)
    assert stems(axes)[:-1, 1] == pytest.approx([1000.0, 1250.0, 1750.0, 2000.0])


def test_no_vibration_has_no_height(axes):
    draw_cascade(axes, made([100.0, 200.0], [wave(0.0)] * 2), DAMPER, "y")
    assert stems(axes)[:-1, 2] == pytest.approx(0.0)


def test_needs_a_stable_range(axes):
    kinds = (Instability.NEIMARK_SACKER,) * 2
    with pytest.raises(ValueError, match="cascade: the response is stable at fewer than two"):
        draw_cascade(axes, made([100.0, 200.0], [wave(1.0)] * 2, kinds), DAMPER)
