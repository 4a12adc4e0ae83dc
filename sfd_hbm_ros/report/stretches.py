"""Stable and unstable stretches of a branch, where they meet, and how they are drawn."""

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.report.style import DASHES, LINE
from sfd_hbm_ros.response.curves.judged import CurveBranch

Array = NDArray[np.float64]

PIECES = 8
"""Straight pieces in which the arc from a point to the next is drawn."""


@dataclass(frozen=True)
class Stretch:
    """Neighbouring points of a branch, joined by arcs that are all stable or all unstable.

    Attributes
    ----------
    points : slice
        The points; the first and the last belong to the neighbouring stretches too.
    stable : bool
        Whether the arcs are stable.
    """

    points: slice
    stable: bool


def stretches(branch: CurveBranch) -> list[Stretch]:
    """The stretches of a branch, in the order of its arc."""
    found, start = [], 0
    changes = {point for point, _ in losses(branch)}
    arcs = (_stable_after(branch, changes, i) for i in range(len(branch.solutions) - 1))
    for stable, run in groupby(arcs):
        end = start + len(list(run))
        found.append(Stretch(slice(start, end + 1), stable))
        start = end
    return found


def losses(branch: CurveBranch) -> Iterator[tuple[int, Instability]]:
    """Points at which a branch folds or loses its stability in another way, and which way."""
    yield from ((int(i), Instability.FOLD) for i in branch.fold.nonzero()[0])
    yield from branch.onsets


def draw_branch(
    axes: Axes, branch: CurveBranch, abscissa: Array, ordinate: Array, colour: str
) -> None:
    """Draw a quantity of a branch, stable stretches solid and unstable ones dashed.

    Each arc from a point to the next is a cubic in `PIECES` pieces, which stays between them.
    """
    last = len(branch.solutions) - 1
    if last == 0:
        return
    arcs = PchipInterpolator(np.arange(last + 1), np.column_stack([abscissa, ordinate]))
    points = arcs(np.arange(PIECES * last + 1) / PIECES)
    for stretch in stretches(branch):
        first, end = PIECES * stretch.points.start, PIECES * (stretch.points.stop - 1) + 1
        axes.plot(
            *points[first:end].T,
            color=colour,
            linewidth=LINE,
            linestyle="-" if stretch.stable else DASHES,
        )


def unstable_key(branches: Iterable[CurveBranch], colour: str) -> list[Line2D]:
    """Legend of the dashes, if branches have any."""
    if all(stretch.stable for branch in branches for stretch in stretches(branch)):
        return []
    return [Line2D([], [], color=colour, linewidth=LINE, linestyle=DASHES, label="unstable")]


def _stable_after(branch: CurveBranch, changes: Container[int], i: int) -> bool:
    """Whether the arc from a point to the next is stable; changes belong to both their sides."""
    stable = [branch.instability[j] is None for j in (i, i + 1) if j not in changes]
    return bool(stable) and all(stable)
