"""What all pictures share: their size and type, their colours, and the file.

Figures are made without pyplot, so that nothing is kept between them and no display is needed.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_hex
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.ticker import FuncFormatter

from sfd_hbm_ros.report.units import grouped

INK = "#12355b"
"""Of the only curve in a picture, and of what belongs to x."""

SECOND = "#e08214"
"""Of what belongs to y; lighter than INK where colours are lost."""

QUIET = "0.45"
"""Of what explains: limits, guides, keys."""

LINE = 1.5
"""Width of a curve [pt]; guides have half of it."""

DASHES = (0, (3.2, 1.6))
"""Of everything unstable."""

BESIDE: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
"""Options of a legend that stands beside its axes."""

_LEGEND: dict[str, Any] = {
    "fontsize": 8.0,
    "framealpha": 0.85,
    "edgecolor": "none",
    "handlelength": 2.6,
}
_STYLE: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "0.3",
    "xtick.color": "0.3",
    "ytick.color": "0.3",
    "xtick.labelcolor": "0.1",
    "ytick.labelcolor": "0.1",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
}


def new_figure(
    rows: int = 1,
    columns: int = 1,
    size: tuple[float, float] = (6.3, 3.7),
    share_x: bool = False,
) -> tuple[Figure, list[Axes]]:
    """Make an empty figure in the pictures' style.

    Parameters
    ----------
    rows, columns : int
        Grid of the axes.
    size : (float, float)
        Width and height [in]; the default width is that of the text on an A4 page.
    share_x : bool
        Whether axes above each other have one abscissa.

    Returns
    -------
    The figure and its axes, row by row.
    """
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False, sharex="col" if share_x else False)
    return figure, list(axes.ravel())


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure to a file.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : str or Path
        The file; its suffix is the format, such as .png, .pdf or .svg.

    Raises
    ------
    OSError
        If the file cannot be written.
    ValueError
        If there is no such format.
    """
    figure.savefig(path, dpi=200)


def shades(number: int) -> list[str]:
    """Colours of an ordered family of curves, from dark to light; one alone is INK."""
    if number == 1:
        return [INK]
    ramp = LinearSegmentedColormap.from_list(
        "ordered", ["#0d1b3e", "#2471a3", "#35a79c", "#f0a33c"]
    )
    return [to_hex(colour) for colour in ramp(np.linspace(0.0, 1.0, number))]


def label_abscissa(axes: Axes, title: str) -> None:
    """Name an abscissa of plain numbers, and let it end where the data do."""
    axes.set_xlabel(title)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: grouped(value)))
    axes.margins(x=0.0)


def label_eccentricity(axes: Axes) -> None:
    """Make the ordinate one of eccentricities; it ends at the clearance if they come near it."""
    axes.set_ylabel("eccentricity $\\varepsilon$ [-]")
    highest = axes.dataLim.ymax
    axes.set_ylim(0.0, 1.0 if highest > 0.5 else 1.1 * highest)


def legend(axes: Axes, handles: Sequence[Artist] | None = None, **options: Any) -> Legend:
    """Put a legend where it covers least, of the labelled artists or of the given ones."""
    handles = axes.get_legend_handles_labels()[0] if handles is None else handles
    return axes.legend(handles=handles, **(_LEGEND | options))
