"""Probability of a jump against speed, of a run-up and of a coast-down."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import PercentFormatter
from numpy.typing import NDArray

from sfd_hbm_ros.report.jumps import COLOURS
from sfd_hbm_ros.report.style import LINE, QUIET, label_abscissa, legend
from sfd_hbm_ros.report.units import grouped
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.units import RPM

_NAMES = {
    Direction.RUN_UP: "run-up $\\rightarrow$",
    Direction.COAST_DOWN: "coast-down $\\leftarrow$",
}
_MARGIN = 0.08  # of the abscissa, on either side of the jumps
_CONFIDENCE = 0.95


def draw_probability(axes: Axes, results: Results, lowest: float, highest: float) -> None:
    """Draw the part of the variants that have jumped by the time they come to a speed.

    It rises to the right in a run-up, to the left in a coast-down. Variants without a solution are
    left out. Where all that varies is sampled, a band holds the whole curve of infinitely many
    samples with a confidence of 95 %.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    results : Results
        The study.
    lowest, highest : float
        Range of the speed [rad/s]; only what lies about the jumps is shown.
    """
    ends = np.array([lowest, highest])
    jumps = np.concatenate([results.jump_speeds(direction) for direction in Direction])
    if jumps.size:
        margin = _MARGIN * np.ptp(jumps) + RPM
        ends = np.clip([jumps.min() - margin, jumps.max() + margin], lowest, highest)
    chance = bool(results.design.scatter) and not results.design.grid
    for direction in Direction:
        _draw_steps(axes, results, direction, ends / RPM, chance)
    axes.set_ylim(0.0, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_ylabel("probability of a jump" if chance else "variants that have jumped")
    label_abscissa(axes, "speed [rpm]")
    legend(axes)
    _explain(axes, results, chance)


def _draw_steps(
    axes: Axes, results: Results, direction: Direction, ends: NDArray[np.float64], chance: bool
) -> None:
    """One way, from the end of the abscissa [rpm] at which it begins to the other."""
    speeds, shares = results.jumped(direction)
    begin, end = ends if direction is Direction.RUN_UP else ends[::-1]
    total = shares[-1] if shares.size else 0.0
    rpm, share = np.array([begin, *speeds / RPM, end]), np.array([0.0, *shares, total])
    colour = COLOURS[direction]
    label = f"{_NAMES[direction]}, {100.0 * total:.3g} % jump"
    axes.step(rpm, share, where="post", color=colour, linewidth=LINE, label=label)
    if chance:
        half = _half_width(int(results.solved.sum()))
        low, high = np.clip([share - half, share + half], 0.0, 1.0)
        axes.fill_between(rpm, low, high, step="post", color=colour, alpha=0.12, linewidth=0.0)


def _half_width(number: int) -> float:
    """Half of the width of the confidence band by Dvoretzky, Kiefer, Wolfowitz and Massart."""
    return math.sqrt(math.log(2.0 / (1.0 - _CONFIDENCE)) / (2.0 * number))


def _explain(axes: Axes, results: Results, chance: bool) -> None:
    """Say what is shown: how many variants, and what the shading means."""
    solved = int(results.solved.sum())
    text = f"{grouped(solved)} variants"
    if solved < len(results.outcomes):
        text += f", {grouped(len(results.outcomes) - solved)} without a solution left out"
    if chance:
        text += f"; shaded: {100.0 * _CONFIDENCE:g} % confidence"
    axes.set_title(text, loc="right", color=QUIET, fontsize=8.0)
