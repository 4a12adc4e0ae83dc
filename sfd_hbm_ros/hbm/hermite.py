"""Hermite's polynomial through points of a branch, along which others are sought."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.points import Point

Array = NDArray[np.float64]

_ALONG = 0.5  # least cosine between the tangents of points that one polynomial joins
_SMALLER = 0.5  # of what the points before it contribute, that of a point that still helps


def along_branch(points: Sequence[Point], scale: Array) -> Callable[[float], Array]:
    """Newton's form of the polynomial through points of a branch with their tangents.

    Parameters
    ----------
    points : sequence of Point
        Neighbours on the branch, the first being the nearest to what is sought. They are used as
        far as the branch goes on in the direction of the first.
    scale : (n + 1,) array
        What the unknowns are compared to.

    Returns
    -------
    callable
        Scaled unknowns (n + 1,) at a distance along the tangent of the first point, with an error
        of the order 2 m in the distances, m being the number of points. A point whose part is not
        clearly smaller than that of those before it is left out, with those behind it.
    """
    first = points[0]
    start = np.append(first.x, first.value) / scale
    nodes, values, slopes = [0.0], [start], [first.tangent]
    for point in points[1:]:
        unknowns, cosine = np.append(point.x, point.value) / scale, first.tangent @ point.tangent
        distance = float(first.tangent @ (unknowns - start))
        if cosine < _ALONG or distance in nodes:
            break
        nodes.append(distance)
        values.append(unknowns)
        slopes.append(point.tangent / cosine)  # its derivative by the distance
    z = np.repeat(nodes, 2)
    factors = _divided_differences(z, np.array(values), np.array(slopes))

    def at(distance: float) -> Array:
        reached: Array = start + distance * first.tangent
        product, before = distance**2, np.inf
        for i in range(2, len(z), 2):
            part = product * (factors[i] + (distance - z[i]) * factors[i + 1])
            size = float(np.linalg.norm(part))
            if size > _SMALLER * before:
                break
            reached = reached + part
            product, before = product * (distance - z[i]) ** 2, size
        return reached

    return at


def _divided_differences(z: Array, values: Array, slopes: Array) -> list[Array]:
    """Factors of Newton's form over the nodes z, each of them twice (Stoer and Bulirsch 2.1.5)."""
    table = np.repeat(values, 2, axis=0)
    factors = [table[0]]
    column = np.empty((len(z) - 1, table.shape[1]))
    column[::2] = slopes
    column[1::2] = (values[1:] - values[:-1]) / (z[2::2] - z[:-2:2])[:, np.newaxis]
    factors.append(column[0])
    for order in range(2, len(z)):
        column = (column[1:] - column[:-1]) / (z[order:] - z[:-order])[:, np.newaxis]
        factors.append(column[0])
    return factors
