"""Figures, colours and files."""

import subprocess
import sys

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from sfd_hbm_ros.report.bode import draw_bode
from sfd_hbm_ros.report.campbell import draw_campbell
from sfd_hbm_ros.report.cascade import draw_cascade
from sfd_hbm_ros.report.curves import draw_response, draw_study
from sfd_hbm_ros.report.orbit import draw_orbits
from sfd_hbm_ros.report.spectrum import draw_spectrum
from sfd_hbm_ros.report.style import new_figure, save, shades
from sfd_hbm_ros.report.units import grouped
from sfd_hbm_ros.rotor import campbell

from .curves import DAMPER, jumping, sagging

CURVES = (("no gravity", jumping), ("gravity", sagging))


def test_settings_of_others_stay_as_they_are():
    before = dict(matplotlib.rcParams)
    figure, _ = new_figure(2, 2)
    assert dict(matplotlib.rcParams) == before
    assert len(figure.axes) == 4


def test_all_pictures_fit_in_one_figure(tmp_path):
    """Every glyph is there and the layout works out: matplotlib would warn."""
    figure, axes = new_figure(4, 2, size=(9.0, 13.0))
    orbits = {name: curve().branches[0].solutions[0].journals[DAMPER] for name, curve in CURVES}
    draw_response(axes[0], jumping(), DAMPER)
    draw_study(axes[1], {name: curve() for name, curve in CURVES}, DAMPER)
    draw_bode(axes[2], axes[4], sagging(), DAMPER)
    draw_orbits(axes[3], orbits)
    draw_spectrum(axes[5], orbits["gravity"])
    draw_cascade(axes[6], sagging(), DAMPER)
    speeds = np.array([0.0, 500.0])
    draw_campbell(axes[7], speeds, campbell(sagging().balance.model, speeds))
    save(figure, tmp_path / "all.png")
    data = (tmp_path / "all.png").read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = (int.from_bytes(data[i : i + 4], "big") for i in (16, 20))
    assert (width, height) == (1800, 2600)


def test_refuses_an_unknown_format(tmp_path):
    figure, _ = new_figure()
    with pytest.raises(ValueError, match="'doc' is not supported"):
        save(figure, tmp_path / "picture.doc")


def test_needs_no_display():
    """Nor is pyplot, with its list of open figures, imported; tables do without matplotlib."""
    script = """if True:
        import sys
        import sfd_hbm_ros.report.table
        assert "matplotlib" not in sys.modules
        from sfd_hbm_ros.report import bode, campbell, cascade, curves, orbit, spectrum
        assert "matplotlib.pyplot" not in sys.modules
    """
    subprocess.run([sys.executable, "-c", script], check=True)


@pytest.mark.parametrize("number", [1, 2, 3, 5])
def test_shades_can_be_told_apart_without_colour(number):
    grey = [np.dot(to_rgb(shade), [0.299, 0.587, 0.114]) for shade in shades(number)]
    assert len(grey) == number
    assert np.all(np.diff(grey) > 0.08)
    assert grey[-1] < 0.75  # dark enough on white


@pytest.mark.parametrize(
    ("number", "text"),
    [(4162, "4\u2009162"), (999.5, "999.5"), (1e6, "1\u2009000\u2009000"), (0.0005, "0.0005")],
)
def test_grouped(number, text):
    assert grouped(number) == text
