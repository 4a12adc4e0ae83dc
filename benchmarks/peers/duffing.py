"""A continuation point of Duffing's oscillator, beside contique's."""

import itertools
from collections.abc import Iterator
from typing import cast

import numpy as np

from benchmarks.peers.environments import Peer
from benchmarks.peers.oscillator import Array, Duffing
from benchmarks.peers.problem import NEWTON, Row, median_seconds
from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate, with_folds
from sfd_hbm_ros.hbm.family import Family
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Point

CONTIQUE = Peer("contique", "1.1.1", "contique")
HARMONICS, SAMPLES = 7, 128
BOUNDS = 0.5, 2.5
STEP = 0.02
COMPARED = 20  # points of the peer's branch


class DuffingFamily:
    """The oscillator as its frequency varies: a `Family`, but for the machine behind it."""

    def __init__(self, oscillator: Duffing) -> None:
        self.oscillator = oscillator
        self.at = oscillator.at

    def slope(self, equations: object, value: float, x: Array) -> Array:
        """See `Family`."""
        return self.oscillator.slope(x, value)


def duffing_branch(oscillator: Duffing, start: float, end: float, step: float) -> Branch:
    """The branch from one frequency to another, by arcs up to a part of the scales."""
    first = newton(oscillator.at(start), oscillator.linear_response(start), NEWTON).x
    options = ContinuationOptions(first_step=step, longest_step=step)
    family = cast(Family, DuffingFamily(oscillator))  # a branch asks for no machine
    return Branch(family, first, start, end, options=options, newton=NEWTON)


def rows() -> Iterator[Row]:
    """The one row."""
    theirs = CONTIQUE.run(
        {"harmonics": HARMONICS, "samples": SAMPLES, "bounds": BOUNDS, "step": STEP}
    )
    oscillator = Duffing(Harmonics(HARMONICS, SAMPLES))
    points: list[Point] = []

    def follow() -> None:
        points[:] = duffing_branch(oscillator, *BOUNDS, STEP)

    elapsed = median_seconds(follow, repeats=5)
    found = np.array(theirs["points"])
    inside = found[(found[:, -1] > BOUNDS[0]) & (found[:, -1] < BOUNDS[1])]
    some = inside[:: max(1, len(inside) // COMPARED)]
    branch = duffing_branch(oscillator, *BOUNDS, STEP)
    ours = list(with_folds(branch, branch))
    worst = max(_distance(branch, [point for point, _ in ours], one) for one in some)
    folds = sum(fold for _, fold in ours)
    turns = np.count_nonzero(np.diff(np.sign(np.diff(found[:, -1]))))
    yield Row(
        f"continuation point of Duffing's oscillator, k = {HARMONICS}",
        "contique",
        elapsed / len(points),
        theirs["seconds"],
        f"{len(some)} points to {worst:.0e}; {len(points)} and {len(found)} points, {folds} and "
        f"{turns} folds",
    )


def _distance(branch: Branch, points: list[Point], other: Array) -> float:
    """How far another's point (coefficients, frequency) lies from ours at its frequency."""
    found = []
    for before, after in itertools.pairwise(points):
        if (before.value - other[-1]) * (after.value - other[-1]) <= 0.0:
            point = locate(branch, before, after, lambda at: float(at.value - other[-1]))
            if point is not None:
                found.append(float(np.abs(point.x - other[:-1]).max()))
    return min(found)
