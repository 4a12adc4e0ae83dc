"""Cascade (waterfall) plot: the spectra of a run-up, one above the other."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import JournalMotion, Solution
from sfd_hbm_ros.report.stretches import stretches
from sfd_hbm_ros.report.style import INK, LINE, QUIET
from sfd_hbm_ros.report.units import MICROMETRE, grouped
from sfd_hbm_ros.report.vibration import vibration
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]

_SPECTRA = 40  # that a range holds at most
_TALLEST = 0.15  # height of the greatest amplitude, of the range of speeds
_SEEN = 0.02  # part of the greatest amplitude below which a harmonic is not seen


def draw_cascade(
    axes: Axes, curve: ResponseCurve, damper: str, axis: Literal["x", "y"] = "x"
) -> None:
    """Draw the spectra that a slow run-up shows, each standing on its speed.

    The mean (0x) is left out, and so are orders above 2x that cannot be seen, and speeds at which
    the run-up meets a quasi-periodic response: it has no orders of the speed.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    curve : ResponseCurve
        The curve, over the speed; its stable points are drawn.
    damper : str
        The damper.
    axis : {"x", "y"}
        The direction in which a probe looks.

    Raises
    ------
    ValueError
        If the curve has fewer than two stable points.
    """
    solutions = _run_up(curve)
    if len(solutions) < 2:
        raise ValueError("cascade: the response is stable at fewer than two speeds")
    solutions = _spread(solutions)
    rpm = np.array([one.speed for one in solutions]) / RPM
    amplitudes = _amplitudes([one.journals[damper] for one in solutions], axis)
    greatest = max(float(one.max()) for one in amplitudes.values()) or 1.0
    height = _TALLEST * (rpm[-1] - rpm[0]) / greatest
    shown = {o: a for o, a in amplitudes.items() if o in (1, 2) or a.max() >= _SEEN * greatest}
    right = 1.05 * float(max(shown)) * rpm[-1] / 60.0
    axes.hlines(rpm, 0.0, right, color="0.85", linewidth=0.4 * LINE)
    for order, amplitude in shown.items():
        _draw_order(axes, order, rpm, height * amplitude)
    _draw_scale(axes, axis, float(f"{0.5 * greatest:.0e}"), height, (0.98 * right, rpm[0]))
    axes.grid(False)
    axes.set(xlabel="frequency [Hz]", ylabel="speed [rpm]", xlim=(0.0, right))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: grouped(value)))


def _amplitudes(motions: list[JournalMotion], axis: str) -> dict[Fraction, Array]:
    """Amplitude in each motion of every order but 0, rising, that occurs [um]."""
    column = "xy".index(axis)
    vibrations = [vibration(motion) for motion in motions]
    orders = sorted({order for one in vibrations for order in one if order > 0})
    nothing = np.zeros(2)
    return {
        order: np.array([abs(one.get(order, nothing)[column]) for one in vibrations]) / MICROMETRE
        for order in orders
    }


def _draw_order(axes: Axes, order: Fraction, rpm: Array, heights: Array) -> None:
    """Draw one harmonic in all spectra, and the line on which it moves."""
    frequency, top = float(order) * rpm / 60.0, rpm + heights
    axes.plot(frequency, rpm, color=QUIET, linewidth=0.4 * LINE, linestyle=":")
    axes.vlines(frequency, rpm, top, color=INK, linewidth=LINE)
    _write(axes, f"{order}x", (frequency[-1], top[-1]), (0.0, 3.0), ha="center", va="bottom")


def _draw_scale(
    axes: Axes, axis: str, amplitude: float, height: float, foot: tuple[float, float]
) -> None:
    """Draw the height of a round amplitude [um], in the corner that harmonics leave empty."""
    x, y = foot
    axes.vlines(x, y, y + height * amplitude, color=INK, linewidth=LINE)
    text = f"{grouped(amplitude)} µm of ${axis}$, 0-pk"
    _write(axes, text, (x, y + 0.5 * height * amplitude), (-4.0, 0.0), ha="right", va="center")


def _write(
    axes: Axes,
    text: str,
    place: tuple[float, float],
    offset: tuple[float, float],
    ha: Literal["center", "right"],
    va: Literal["bottom", "center"],
) -> None:
    axes.annotate(text, place, offset, textcoords="offset points", ha=ha, va=va, fontsize=8.0)


def _run_up(curve: ResponseCurve) -> list[Solution]:
    """Stable points in rising order of speed; where there are several, that which came first."""
    met: list[Solution] = []
    reached = -np.inf
    for branch in _in_order(curve):
        for stretch in stretches(branch):
            if stretch.stable:
                points = np.arange(len(branch.solutions))[stretch.points]
                stable = [branch.solutions[i] for i in points[branch.stable[points]]]
                new = [one for one in stable if one.speed > reached]
                met += [one for one in new if isinstance(one, Solution)]
                reached = max([reached, *(one.speed for one in new)])
    return sorted(met, key=lambda one: one.speed)


def _in_order(curve: ResponseCurve) -> Iterator[CurveBranch]:
    """The branches, each that is quasi-periodic behind the one that it leaves."""
    for branch in filter(lambda one: one.periodic, curve.branches):
        yield branch
        for other in curve.branches:
            if not other.periodic and curve.meeting(other, 0)[0][0] is branch:
                yield other


def _spread(solutions: list[Solution]) -> list[Solution]:
    """Solutions so far apart that at most `_SPECTRA` fill the range."""
    gap = (solutions[-1].speed - solutions[0].speed) / _SPECTRA
    spread = solutions[:1]
    for solution in solutions[1:]:
        if solution.speed >= spread[-1].speed + gap:
            spread.append(solution)
    return spread
