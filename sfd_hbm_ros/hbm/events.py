"""Events on a branch, located between two of its points."""

from collections.abc import Iterable, Iterator

from scipy.optimize import brentq

from sfd_hbm_ros.hbm.continuation import Branch, Point

_FOLD_ACCURACY = 1e-5
"""Of the arc, relative to the step in which a fold lies. The parameter errs with its square."""


def with_folds(branch: Branch, points: Iterable[Point]) -> Iterator[tuple[Point, bool]]:
    """The points of a branch with every fold put in between, and whether a point is a fold."""
    before: Point | None = None
    for point in points:
        if before is not None and before.tangent[-1] * point.tangent[-1] < 0.0:
            fold = locate_fold(branch, before, point)
            if fold is not None:
                yield fold, True
        yield point, False
        before = point


def locate_fold(branch: Branch, before: Point, after: Point) -> Point | None:
    """The point at which the branch turns back in the parameter.

    Parameters
    ----------
    branch : Branch
        The branch.
    before, after : Point
        Neighbouring points, between which the parameter's part of the tangent changes its sign.

    Returns
    -------
    The fold, or None where the corrector found no point of the branch on the way.
    """
    length = branch.distance(before, after)
    found: list[Point] = []

    def tangent_at(step: float) -> float:
        point = branch.corrected(before, step) if step > 0.0 else before
        if point is None:
            raise ArithmeticError("the corrector failed")
        found.append(point)
        return float(point.tangent[-1])

    try:
        brentq(tangent_at, 0.0, length, xtol=_FOLD_ACCURACY * length, rtol=1e-12)
    except (ArithmeticError, ValueError):
        return None
    return min(found, key=lambda point: abs(point.tangent[-1]))
