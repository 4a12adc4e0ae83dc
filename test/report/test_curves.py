"""Response curves as drawn."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.report.curves import draw_response, draw_study
from sfd_hbm_ros.report.style import new_figure
from sfd_hbm_ros.response.curves.jumps import Direction, Jump, jumps

from . import reading
from .curves import DAMPER, RPM, UNBALANCE, jumping, made, motion, sagging, unbalanced


@pytest.fixture
def axes():
    return new_figure()[1][0]


@pytest.mark.parametrize("curve", [jumping, sagging])
def test_lines_are_the_curve(axes, curve):
    draw_response(axes, curve(), DAMPER)
    drawn = reading.drawn(axes)
    assert len(drawn) == len(curve().branches)
    for points, branch in zip(drawn, curve().branches, strict=True):
        expected = np.column_stack([branch.speed / RPM, branch.eccentricity(DAMPER)])
        assert np.allclose(points, expected, rtol=1e-12)


@pytest.mark.parametrize("curve", [jumping, sagging])
def test_unstable_is_dashed(axes, curve):
    """A point inside a line is stable if and only if the line is solid."""
    draw_response(axes, curve(), DAMPER)
    eccentricity, stable = (
        np.concatenate([get(branch) for branch in curve().branches])
        for get in (lambda branch: branch.eccentricity(DAMPER), lambda branch: branch.stable)
    )
    seen = 0
    for line in reading.curves(axes):
        for _, height in reading.knots(line)[1:-1]:
            nearest = np.argmin(np.abs(eccentricity - height))
            assert stable[nearest] is not np.bool_(reading.is_dashed(line))
            seen += 1
    assert seen > 0.8 * len(stable)
    assert {reading.is_dashed(line) for line in reading.curves(axes)} == {True, False}


def test_lines_stay_between_the_points(axes):
    draw_response(axes, jumping(), DAMPER)
    for line in reading.curves(axes):
        points, pieces = reading.knots(line), line.get_xydata()
        arcs = np.repeat(np.arange(len(points) - 1), reading.PIECES)
        low = np.minimum(points[:-1], points[1:])[arcs]
        high = np.maximum(points[:-1], points[1:])[arcs]
        tolerance = 1e-9 * np.abs(high)
        assert np.all(pieces[:-1] >= low - tolerance)
        assert np.all(pieces[:-1] <= high + tolerance)


def test_marks(axes):
    draw_response(axes, jumping(), DAMPER)
    first, second, leaving = jumping().branches
    [fold] = np.flatnonzero(second.fold)
    [mark] = reading.marks(axes, "o")
    assert mark == pytest.approx([second.speed[fold] / RPM, second.eccentricity(DAMPER)[fold]])
    [mark] = reading.marks(axes, "s")
    lost = np.flatnonzero(first.stable)[-1] + 1
    assert mark == pytest.approx([first.speed[lost] / RPM, first.eccentricity(DAMPER)[lost]])
    assert leaving.eccentricity(DAMPER)[0] == pytest.approx(mark[1], rel=1e-12)
    assert reading.legend(axes) == ["unstable", "fold", "Neimark-Sacker"]


def test_quasi_periodic_branch_is_drawn_from_its_onset(axes):
    draw_response(axes, jumping(), DAMPER)
    leaving = jumping().branches[2]
    [mark] = reading.marks(axes, "s")
    [line] = [line for line in reading.curves(axes) if np.allclose(line.get_xydata()[0], mark)][1:]
    assert not reading.is_dashed(line)
    expected = np.column_stack([leaving.speed / RPM, leaving.eccentricity(DAMPER)])
    assert np.allclose(reading.knots(line), expected)


@pytest.mark.parametrize("kind", [kind for kind in Instability if kind is not Instability.FOLD])
def test_every_loss_of_stability_has_its_mark(axes, kind):
    still = [motion(np.ones((3, 2)))] * 3
    draw_response(axes, made([100.0, 200.0, 300.0], still, (None, kind, kind)), DAMPER)
    assert reading.legend(axes) == ["unstable", kind.value]


def test_jumps(axes):
    found = [jump for direction in Direction for jump in jumps(sagging(), direction)]
    draw_response(axes, sagging(), DAMPER, found)
    arrows = [line for line in axes.lines if line.get_markevery() == [1]]
    ends = [line.get_xydata() for line in arrows]
    expected = [
        [
            [jump.value / RPM, one.journals[DAMPER].eccentricity_max]
            for one in (jump.before, jump.after)
        ]
        for jump in found
    ]
    assert np.allclose(ends, expected, rtol=1e-13)
    # an arrow up has its head below the tip, and one down above it
    heads = [line.get_marker().vertices[:, 1].mean() for line in arrows]
    assert all(
        head * (end - start) < 0 for head, ((_, start), (_, end)) in zip(heads, ends, strict=True)
    )
    up, down = (np.sort(sagging().branches[0].values[sagging().branches[0].fold]) / RPM)[::-1]
    assert reading.legend(axes)[2:] == [
        f"run-up jump, 3\u2009{up - 3000:.1f} rpm",
        f"coast-down jump, 3\u2009{down - 3000:.1f} rpm",
    ]


def test_axes_have_names_and_units(axes):
    draw_response(axes, sagging(), DAMPER)
    assert axes.get_xlabel() == "speed [rpm]"
    assert axes.get_ylabel() == "eccentricity $\\varepsilon$ [-]"
    assert axes.get_xlim() == pytest.approx((3900.0, 4100.0))
    assert axes.get_ylim() == (0.0, 1.0)
    assert axes.xaxis.get_major_formatter()(4000.0) == "4\u2009000"


def test_small_eccentricity_fills_the_picture(axes):
    small = motion(np.array([[0.0, 0.0], [1e-6, 0.0], [0.0, 1e-6]]), clearance=1e-4)
    draw_response(axes, made([100.0, 200.0], [small, small]), DAMPER)
    assert axes.get_ylim() == pytest.approx((0.0, 0.011))
    assert axes.get_legend() is None  # there is nothing to explain


def test_an_entry_of_the_machine_file(axes):
    curve = unbalanced()
    [branch] = curve.branches
    first, last = branch.solutions[0], branch.solutions[-1]
    made_up = [Jump(direction, branch.values[0], first, last) for direction in Direction]
    draw_response(axes, curve, DAMPER, made_up)
    assert axes.get_xlabel() == f"{UNBALANCE} [kg m]"
    points = reading.knots(reading.curves(axes)[0])
    assert np.allclose(points[:, 0], branch.values, rtol=1e-12)
    assert reading.legend(axes) == ["jump on rising, 0.0001 kg m", "jump on falling, 0.0001 kg m"]


def test_study(axes):
    draw_study(axes, {"no gravity": jumping(), "gravity": sagging()}, DAMPER)
    assert reading.legend(axes) == [
        "no gravity",
        "gravity",
        "unstable",
        "fold",
        "Neimark-Sacker",
    ]
    drawn = reading.drawn(axes)
    expected = [*jumping().branches, *sagging().branches]
    assert [len(points) for points in drawn] == [len(branch.values) for branch in expected]
    # light enough apart to tell without colours
    dark, light = (
        np.dot(to_rgb(line.get_color()), [0.299, 0.587, 0.114])
        for line in axes.get_legend().get_lines()[:2]
    )
    assert light - dark > 0.3
