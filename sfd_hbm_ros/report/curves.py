"""Response curves: eccentricity over speed, stable and unstable, with folds and jumps."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.report.abscissa import Abscissa
from sfd_hbm_ros.report.jumps import draw_jumps
from sfd_hbm_ros.report.stretches import draw_branch, losses, unstable_key
from sfd_hbm_ros.report.style import (
    INK,
    LINE,
    QUIET,
    label_abscissa,
    label_eccentricity,
    legend,
    shades,
)
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.jumps import Jump
from sfd_hbm_ros.response.curves.peaks import Peak

_MARKERS = {
    Instability.FOLD: "o",
    Instability.NEIMARK_SACKER: "s",
    Instability.PERIOD_DOUBLING: "D",
    Instability.SYMMETRY_BREAKING: "^",
}


def draw_response(
    axes: Axes,
    curve: ResponseCurve,
    damper: str,
    jumps: Iterable[Jump] = (),
    peaks: Iterable[Peak] = (),
) -> None:
    """Draw one response curve: stable solid, unstable dashed, losses of stability marked.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    curve : ResponseCurve
        The curve, over the speed or over an entry of the machine file.
    damper : str
        The damper whose eccentricity is drawn.
    jumps : iterable of Jump, optional
        Jumps of the curve, drawn as arrows.
    peaks : iterable of Peak, optional
        Peaks of vibrations, of which those of this damper are marked.
    """
    abscissa = Abscissa.of(curve)
    _draw(axes, curve, damper, abscissa, INK)
    arrows = draw_jumps(axes, jumps, damper, abscissa)
    stars = [_star(axes, peak, abscissa) for peak in peaks if peak.of == damper]
    label_abscissa(axes, abscissa.title)
    label_eccentricity(axes)
    keys = [*_keys(curve.every_branch, INK), *arrows, *stars]
    if keys:
        legend(axes, keys)


def draw_study(axes: Axes, curves: Mapping[str, ResponseCurve], damper: str) -> None:
    """Draw the response curves of a study in one picture.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    curves : mapping of str to ResponseCurve
        At least one curve, all over the same parameter, by their names in the legend and in the
        order of what differs.
    damper : str
        The damper whose eccentricity is drawn.
    """
    names = []
    for (name, curve), colour in zip(curves.items(), shades(len(curves)), strict=True):
        abscissa = Abscissa.of(curve)
        _draw(axes, curve, damper, abscissa, colour)
        names.append(Line2D([], [], color=colour, linewidth=LINE, label=name))
    label_abscissa(axes, abscissa.title)
    label_eccentricity(axes)
    branches = [branch for curve in curves.values() for branch in curve.every_branch]
    legend(axes, [*names, *_keys(branches, QUIET)])


def _draw(axes: Axes, curve: ResponseCurve, damper: str, abscissa: Abscissa, colour: str) -> None:
    for branch in curve.every_branch:
        place, eccentricity = branch.values / abscissa.unit, branch.eccentricity(damper)
        draw_branch(axes, branch, place, eccentricity, colour)
        for i, kind in losses(branch):
            axes.plot(place[i], eccentricity[i], **_mark(kind, colour))


def _star(axes: Axes, peak: Peak, abscissa: Abscissa) -> Line2D:
    """Mark a peak where its response lies, and return its key for the legend."""
    style: dict[str, Any] = {"linestyle": "none", "marker": "*", "markersize": 8.0, "color": INK}
    height = peak.response.journals[peak.of].eccentricity_max
    axes.plot(peak.value / abscissa.unit, height, **style)
    return Line2D([], [], label=f"peak, {abscissa.worded(peak.value)}", **style)


def _keys(branches: Sequence[CurveBranch], colour: str) -> list[Line2D]:
    """Legend of the dashes and marks that occur."""
    kinds = {kind for branch in branches for _, kind in losses(branch)}
    marks = [
        Line2D([], [], label=kind.value, **_mark(kind, colour))
        for kind in Instability
        if kind in kinds
    ]
    return [*unstable_key(branches, colour), *marks]


def _mark(kind: Instability, colour: str) -> dict[str, Any]:
    return {
        "linestyle": "none",
        "marker": _MARKERS[kind],
        "markersize": 4.5,
        "markerfacecolor": "white",
        "markeredgecolor": colour,
    }
