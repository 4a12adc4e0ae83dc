"""Events on a branch, located between two of its points."""

from collections.abc import Callable, Iterable, Iterator

from sfd_hbm_ros.hbm.bracketing import zero_between
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.points import Point


def locate(
    branch: Branch,
    before: Point,
    after: Point,
    event: Callable[[Point], float],
    accuracy: float = 1e-8,
) -> Point | None:
    """The point of a branch at which a quantity passes through zero.

    Parameters
    ----------
    branch : Branch
        The branch.
    before, after : Point
        Neighbouring points of it, between which the quantity changes its sign.
    event : callable
        The quantity, such as ``lambda point: point.value - speed``, ``point.eccentricity - 0.5``,
        or for a fold ``point.tangent[-1]``.
    accuracy : float
        Part of the step between both points to which it is located.

    Returns
    -------
    The point, or None where the corrector found no point of the branch on the way.
    """
    length = branch.corrector.distance(before, after)
    found: dict[float, Point] = {0.0: before, length: after}

    def quantity(step: float) -> float:
        point = found.get(step) or branch.corrector.corrected(before, step, [after])
        if point is None:
            raise ArithmeticError("the corrector failed")
        found[step] = point
        return event(point)

    try:
        step = zero_between(quantity, 0.0, length, accuracy * length)
    except ArithmeticError:
        return None
    quantity(step)
    return found[step]


def with_folds(branch: Branch, points: Iterable[Point]) -> Iterator[tuple[Point, bool]]:
    """The points of a branch with every fold put in between, and whether a point is a fold."""
    before: Point | None = None
    for point in points:
        if before is not None and before.tangent[-1] * point.tangent[-1] < 0.0:
            fold = locate(branch, before, point, lambda at: float(at.tangent[-1]))
            if fold is not None:
                yield fold, True
        yield point, False
        before = point
