"""What a picture shows, read back from its axes."""

import numpy as np

from sfd_hbm_ros.report.stretches import PIECES


def curves(axes):
    """The lines of curves, that is those without a mark."""
    return [line for line in axes.lines if line.get_marker() == "None"]


def knots(line):
    """The points of a curve through which a line was drawn, (m, 2)."""
    return line.get_xydata()[::PIECES]


def is_dashed(line):
    return line.get_linestyle() == "--"


def marks(axes, marker):
    """Places of the marks of a kind, (m, 2)."""
    places = [line.get_xydata() for line in axes.lines if line.get_marker() == marker]
    return np.concatenate(places) if places else np.empty((0, 2))


def legend(axes):
    """Texts of the legend."""
    return [text.get_text() for text in axes.get_legend().get_texts()]


def drawn(axes):
    """The points of each branch, its lines put together where one goes on from another."""
    branches = []
    for points in map(knots, curves(axes)):
        if branches and np.array_equal(branches[-1][-1], points[0]):
            branches[-1] = np.concatenate([branches[-1], points[1:]])
        else:
            branches.append(points)
    return branches
