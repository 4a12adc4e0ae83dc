"""Campbell diagrams: every mode is drawn, and critical speeds lie where lines cross."""

import numpy as np
import pytest

from sfd_hbm_ros.report.campbell import draw_campbell
from sfd_hbm_ros.report.style import new_figure
from sfd_hbm_ros.rotor import assemble, campbell, critical_speeds

from ..rotor.machines import beam, disk, paper_rotor, rich_rotor
from . import reading
from .curves import RPM


@pytest.fixture
def axes():
    return new_figure()[1][0]


def lines(axes, word):
    return [line for line in axes.lines if word in line.get_label()]


def whirl_lines(axes):
    return [line for word in ("forward", "backward", "planar") for line in lines(axes, word)]


ANISOTROPIC = ((2e7, 0.0), (0.0, 5e7))


@pytest.mark.parametrize(
    "machine",
    [
        paper_rotor(),
        rich_rotor(((5e7, 0.0), (0.0, 5e7)), ((100.0, 0.0), (0.0, 100.0))),
        beam(6, 1.0, 0.05, ANISOTROPIC, disks=(disk("wheel", 2, 0.3, 0.05),)),
    ],
    ids=["paper", "damped", "anisotropic"],
)
def test_every_mode_is_drawn_once(axes, machine):
    speeds = np.linspace(0.0, 1000.0, 5)
    modes = campbell(assemble(machine), speeds)
    draw_campbell(axes, speeds, modes)
    drawn = np.array([line.get_ydata() for line in whirl_lines(axes)])
    for i in range(1, len(speeds)):
        shown = np.sort(drawn[:, i][np.isfinite(drawn[:, i])])
        expected = np.array([mode.frequency for mode in modes[i]]) / (2.0 * np.pi)
        assert np.allclose(shown, expected, rtol=1e-12)
    at_rest = np.array([mode.frequency for mode in modes[0]]) / (2.0 * np.pi)
    begun = drawn[:, 0][np.isfinite(drawn[:, 0])]
    assert np.isin(begun, at_rest).all()
    for line in whirl_lines(axes):
        assert line.get_xdata() == pytest.approx(speeds / RPM)


def test_lines_run_on_from_rest(axes):
    """An axisymmetric rotor's pairs of modes part as it turns, forward up and backward down."""
    speeds = np.linspace(0.0, 500.0, 6)
    draw_campbell(axes, speeds, campbell(assemble(paper_rotor()), speeds))
    for i in range(4):
        forward, backward = lines(axes, "forward")[i], lines(axes, "backward")[i]
        assert forward.get_ydata()[0] == pytest.approx(backward.get_ydata()[0], rel=1e-9)
        assert np.all(np.diff(forward.get_ydata()) > 0.0)
        assert np.all(np.diff(backward.get_ydata()) < 0.0)
        assert (reading.is_dashed(forward), reading.is_dashed(backward)) == (False, True)


def test_critical_speeds_are_crossings(axes):
    model = assemble(paper_rotor())
    criticals = critical_speeds(model)
    speeds = np.linspace(350.0, 450.0, 3)
    draw_campbell(axes, speeds, campbell(model, speeds), criticals)
    marked = [line for line in axes.lines if "critical" in line.get_label()]
    inside = [one for one in criticals if 350.0 <= one.speed <= 450.0]
    assert len(marked) == len(inside) == 2
    for mark, critical in zip(marked, inside, strict=True):
        [[rpm, frequency]] = mark.get_xydata()
        assert rpm == pytest.approx(critical.speed / RPM)
        assert frequency == pytest.approx(rpm / 60.0)
        first = lines(axes, f"{critical.direction} whirl")[0]
        assert np.interp(rpm, *first.get_data()) == pytest.approx(frequency, rel=1e-5)
        assert mark.get_label() == f"{critical.direction} critical, 3\u2009{rpm - 3000:.0f} rpm"


def test_axes_have_names_and_units(axes):
    speeds = np.array([0.0, 100.0 * 60.0 * RPM])
    draw_campbell(axes, speeds, campbell(assemble(paper_rotor()), speeds))
    assert axes.get_xlabel() == "speed [rpm]"
    assert axes.get_ylabel() == "whirl frequency [Hz]"
    assert axes.get_xlim() == pytest.approx((0.0, 6000.0))
    assert axes.get_ylim() == pytest.approx((0.0, 200.0))
    [once] = lines(axes, "1x")
    assert once.get_xydata() == pytest.approx(np.array([[0.0, 0.0], [6000.0, 100.0]]))
    assert reading.legend(axes) == ["forward whirl", "backward whirl", "1x"]
