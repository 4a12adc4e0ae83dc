"""Arrows of the jumps in a response curve."""

from collections.abc import Iterable
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.path import Path

from sfd_hbm_ros.report.abscissa import Abscissa
from sfd_hbm_ros.report.style import LINE
from sfd_hbm_ros.response.curves.jumps import Direction, Jump

COLOURS = {Direction.RUN_UP: "#c4460a", Direction.COAST_DOWN: "#0f8a6a"}
_SPEED_NAMES = {Direction.RUN_UP: "run-up jump", Direction.COAST_DOWN: "coast-down jump"}
_OTHER_NAMES = {Direction.RUN_UP: "jump on rising", Direction.COAST_DOWN: "jump on falling"}
_UP = Path([(0.0, 0.0), (-0.6, -1.6), (0.6, -1.6), (0.0, 0.0)], closed=True)
_DOWN = Path([(0.0, 0.0), (-0.6, 1.6), (0.6, 1.6), (0.0, 0.0)], closed=True)


def draw_jumps(axes: Axes, jumps: Iterable[Jump], damper: str, abscissa: Abscissa) -> list[Line2D]:
    """Draw jumps as arrows, their heads filled for a run-up and open for a coast-down.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    jumps : iterable of Jump
        The jumps.
    damper : str
        The damper whose eccentricity is drawn.
    abscissa : Abscissa
        That of the picture.

    Returns
    -------
    list of Line2D
        A handle for the legend for each.
    """
    return [_arrow(axes, jump, damper, abscissa) for jump in jumps]


def _arrow(axes: Axes, jump: Jump, damper: str, abscissa: Abscissa) -> Line2D:
    before, after = (one.journals[damper].eccentricity_max for one in (jump.before, jump.after))
    colour = COLOURS[jump.direction]
    rises = after > before
    style: dict[str, Any] = {
        "color": colour,
        "markerfacecolor": colour if jump.direction is Direction.RUN_UP else "white",
    }
    place = jump.value / abscissa.unit
    head: dict[str, Any] = {"marker": _UP if rises else _DOWN, "markersize": 8.0, "markevery": [1]}
    axes.plot([place, place], [before, after], linewidth=0.7 * LINE, **head, **style)
    names = _SPEED_NAMES if abscissa.path is None else _OTHER_NAMES
    label = f"{names[jump.direction]}, {abscissa.worded(jump.value)}"
    return Line2D(
        [],
        [],
        linestyle="none",
        marker="^" if rises else "v",
        markersize=5.0,
        label=label,
        **style,
    )
