"""Spectra of a journal's motion: the amplitude of each harmonic as a bar."""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from matplotlib.axes import Axes

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.report.style import INK, SECOND, legend, shades
from sfd_hbm_ros.report.units import MICROMETRE
from sfd_hbm_ros.report.vibration import vibration

Heights = dict[Fraction, float]

_GROUP = 0.7  # width of the bars of one order, of the distance of the orders
_FLOOR = 1e-4  # lower end of a logarithmic ordinate, of the greatest amplitude


def draw_spectrum(
    axes: Axes, motion: JournalMotion, micrometres: bool = False, logarithmic: bool = False
) -> None:
    """Draw the amplitudes of x and y side by side, zero to peak; order 0 is the mean's amount.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    motion : JournalMotion
        The motion.
    micrometres : bool
        Whether amplitudes are in micrometres, instead of clearances.
    logarithmic : bool
        Whether the ordinate is logarithmic, over the uppermost four decades.
    """
    heights = {f"${axis}$": _heights(motion, axis, micrometres) for axis in "xy"}
    _bars(axes, heights, [INK, SECOND], logarithmic)
    axes.set_ylabel(f"amplitude {_unit(micrometres)}")


def draw_spectra(
    axes: Axes,
    motions: Mapping[str, JournalMotion],
    axis: Literal["x", "y"],
    micrometres: bool = False,
    logarithmic: bool = False,
) -> None:
    """Draw the amplitudes of several motions side by side.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    motions : mapping of str to JournalMotion
        The motions by their names in the legend, in the order of what differs.
    axis : {"x", "y"}
        The direction.
    micrometres, logarithmic : bool
        See `draw_spectrum`.
    """
    heights = {name: _heights(motion, axis, micrometres) for name, motion in motions.items()}
    _bars(axes, heights, shades(len(motions)), logarithmic)
    axes.set_ylabel(f"amplitude of ${axis}$ {_unit(micrometres)}")


def _heights(motion: JournalMotion, axis: str, micrometres: bool) -> Heights:
    unit = MICROMETRE if micrometres else motion.clearance
    column = "xy".index(axis)
    return {order: float(abs(q[column])) / unit for order, q in vibration(motion).items()}


def _unit(micrometres: bool) -> str:
    return "[µm, 0-pk]" if micrometres else "[of clearance, 0-pk]"


def _bars(
    axes: Axes, series: Mapping[str, Heights], colours: list[str], logarithmic: bool
) -> None:
    """Draw named series of bars, of each order side by side."""
    orders = {order for heights in series.values() for order in heights}
    distance = 1.0 / math.lcm(*(order.denominator for order in orders))
    width = _GROUP * distance / len(series)
    for i, ((name, heights), colour) in enumerate(zip(series.items(), colours, strict=True)):
        shift = (i - 0.5 * (len(series) - 1)) * width
        places = [float(order) + shift for order in heights]
        axes.bar(places, list(heights.values()), width=0.9 * width, color=colour, label=name)
    whole = range(math.ceil(max(orders)) + 1)
    axes.set_xticks(whole, [f"{order}x" for order in whole])
    axes.tick_params(axis="x", length=0.0)
    axes.grid(False, axis="x")
    axes.set_xlabel("harmonic of the speed")
    if logarithmic:
        highest = max(height for heights in series.values() for height in heights.values())
        axes.set_yscale("log")
        axes.set_ylim(_FLOOR * highest, 2.0 * highest)
    legend(axes)
