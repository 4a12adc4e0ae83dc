"""Orbits of a journal in its clearance circle."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.report.style import BESIDE, LINE, QUIET, legend, shades

Array = NDArray[np.float64]

_REVOLUTION = 2.0 * np.pi
_POINTS = 720  # a revolution
_DOT: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 4.5}


def draw_orbits(axes: Axes, motions: Mapping[str, JournalMotion], close_up: bool = False) -> None:
    """Draw orbits over one period, in clearances.

    Dots mark where the journal is at the rotor's angle 0 of every revolution, when the keyphasor
    pulses.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    motions : mapping of str to JournalMotion
        The motions by their names in the legend; one alone has no legend.
    close_up : bool
        Whether the orbits fill the picture, instead of the clearance circle.
    """
    names = []
    for (name, motion), colour in zip(motions.items(), shades(len(motions)), strict=True):
        revolutions = motion.harmonics.revolutions
        angle = _REVOLUTION * np.arange(_POINTS * revolutions + 1) / _POINTS
        orbit = motion.at(angle).T / motion.clearance
        dots = motion.orbit(revolutions).T / motion.clearance
        names += axes.plot(*orbit, color=colour, linewidth=LINE, label=name)
        axes.plot(*dots, color=colour, **_DOT)
    _frame(axes, close_up)
    if len(motions) > 1:
        dot = Line2D([], [], color=QUIET, label="keyphasor, 0°", **_DOT)
        legend(axes, [*names, dot], **BESIDE)
    else:
        _name_dot(axes, dots[:, 0], motion.coefficients[0] / motion.clearance)


def _name_dot(axes: Axes, dot: Array, centre: Array) -> None:
    """Write the angle beside the first dot, on the side away from the orbit's centre."""
    outward = (dot - centre) / max(np.linalg.norm(dot - centre), np.finfo(float).tiny)
    axes.annotate(
        "0°",
        (dot[0], dot[1]),
        (10.0 * outward[0], 10.0 * outward[1]),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=8.0,
    )


def _frame(axes: Axes, close_up: bool) -> None:
    """Give both axes the same scale, and the picture the size of the orbits or of the circle."""
    box = axes.dataLim
    centre = (0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)) if close_up else (0.0, 0.0)
    half = 0.55 * max(box.width, box.height) if close_up else 1.05
    axes.set_aspect("equal")
    axes.set(
        xlim=(centre[0] - half, centre[0] + half),
        ylim=(centre[1] - half, centre[1] + half),
        xlabel="$x/c$ [-]",
        ylabel="$y/c$ [-]",
    )
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
    axes.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=QUIET, linewidth=0.5 * LINE))
