"""The picture of a study: what its steps and its band show."""

import numpy as np
import pytest
from scipy import stats

from sfd_hbm_ros.report.probability import draw_probability
from sfd_hbm_ros.report.style import new_figure
from sfd_hbm_ros.study.design import Design
from sfd_hbm_ros.study.distributions import Normal
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.study.task import Outcome

from .reading import legend

RPM = np.pi / 30.0
RUN_UPS, COAST_DOWNS = (4050.0, None, 4010.0, 4030.0), (None, 3950.0, 3990.0, 3970.0)
FAILED = Outcome(None, None, None, None, None, 1.0, "no solution")


def outcome(run_up, coast_down):
    speeds = [None if rpm is None else rpm * RPM for rpm in (run_up, coast_down)]
    return Outcome(*speeds, None, 4000.0 * RPM, 0.7, 1.0, "")


def picture(design, outcomes):
    _, [axes] = new_figure()
    draw_probability(axes, Results(design, outcomes), 3000.0 * RPM, 5000.0 * RPM)
    return axes


SAMPLED = Design({}, {"gravity": Normal(0.0, 1.0)}, samples=5)
OUTCOMES = [*map(outcome, RUN_UPS, COAST_DOWNS), FAILED]


def share_at(line, rpm):
    """The height of steps at a speed; a step goes on from its own speed in the way of travel."""
    x, y = line.get_xydata().T
    return y[np.flatnonzero((x <= rpm) if x[0] < x[-1] else (x >= rpm))[-1]]


def test_steps_are_shares_of_the_variants_with_a_solution():
    up, down = picture(SAMPLED, OUTCOMES).lines
    for rpm in (3945.0, 3960.0, 4000.0, 4020.0, 4049.0, 4051.0):
        expected = [
            sum(jump is not None and jump <= rpm for jump in RUN_UPS) / 4.0,
            sum(jump is not None and jump >= rpm for jump in COAST_DOWNS) / 4.0,
        ]
        assert [share_at(up, rpm), share_at(down, rpm)] == pytest.approx(expected)


def test_words():
    axes = picture(SAMPLED, OUTCOMES)
    up, down = legend(axes)
    assert up.startswith("run-up")
    assert down.startswith("coast-down")
    assert up.endswith("75 % jump")
    assert axes.get_ylabel() == "probability of a jump"
    title = axes.get_title(loc="right")
    assert title == "4 variants, 1 without a solution left out; shaded: 95 % confidence"
    low, high = axes.get_xlim()
    assert 3900.0 < low < 3950.0
    assert 4050.0 < high < 4100.0


def test_points_of_a_grid_are_no_matter_of_chance():
    axes = picture(Design({"gravity": (0.0, 1.0, 2.0, 3.0)}, {}), OUTCOMES[:4])
    assert axes.get_ylabel() == "variants that have jumped"
    assert axes.get_title(loc="right") == "4 variants"
    assert len(axes.collections) == 0


def test_without_jumps_the_whole_range_is_shown():
    axes = picture(SAMPLED, [outcome(None, None)] * 5)
    assert axes.get_xlim() == pytest.approx((3000.0, 5000.0))
    assert not any(line.get_ydata().any() for line in axes.lines)


@pytest.mark.parametrize("number", [20, 100, 1000])
def test_the_band_is_as_wide_as_kolmogorovs_test(number):
    """The bound on the greatest distance of the whole curve, against its exact distribution."""
    axes = picture(SAMPLED, [outcome(4000.0 + i, None) for i in range(number)])
    band = axes.collections[0].get_paths()[0].vertices
    begin = band[:, 0] == band[:, 0].min()  # where nothing has jumped yet
    assert band[begin, 1].min() == 0.0
    exact = stats.kstwo(number).ppf(0.95)
    assert exact < band[begin, 1].max() < 1.04 * exact
