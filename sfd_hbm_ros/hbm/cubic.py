"""The cubic through two points of a branch, along which others are sought."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.points import Point

Array = NDArray[np.float64]

_ALONG = 0.5  # least cosine between the tangents of points that one cubic joins


def cubic_through(point: Point, other: Point, scale: Array) -> Callable[[float], Array] | None:
    """Hermite's cubic through two points with their tangents.

    Parameters
    ----------
    point, other : Point
        Neighbouring points of a branch, in either order.
    scale : (n + 1,) array
        What the unknowns are compared to.

    Returns
    -------
    callable or None
        Scaled unknowns (n + 1,) at a distance along the tangent of `point`, right to the fourth
        order of the distances, between the points or beyond. None where the branch turns too much.
    """
    start, end = (np.append(at.x, at.value) / scale for at in (point, other))
    length = point.tangent @ (end - start)
    along = point.tangent @ other.tangent
    if length == 0.0 or along < _ALONG:
        return None
    chord = (end - start) / length
    first, last = point.tangent, other.tangent / along  # derivatives by the distance
    second = 3.0 * chord - 2.0 * first - last
    third = first + last - 2.0 * chord

    def at(distance: float) -> Array:
        part = distance / length
        unknowns: Array = start + distance * (first + part * (second + part * third))
        return unknowns

    return at
