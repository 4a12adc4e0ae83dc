"""Journals within their clearances, at time samples of their motion and between these."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NARROW = 0.98
"""Eccentricity from which on it matters what a journal does between two time samples."""

_NEAREST = 1.0 - 1e-9  # eccentricity beyond which no step goes
_ROOM = 0.9  # part of the gap to the clearance that one step may close at any time sample


def greatest_eccentricity(positions: Array, clearances: Array) -> float:
    """Greatest eccentricity of any journal, between the samples too.

    Parameters
    ----------
    positions : (samples, n) array
        Positions, x and y of each journal in turn [m].
    clearances : (n,) array
        Clearance of each coordinate [m].
    """
    squares = np.square(positions / clearances)
    distances = squares[:, ::2] + squares[:, 1::2]
    journals = np.arange(distances.shape[1])
    top = distances.argmax(axis=0)
    farthest = distances[top, journals]
    beside = [distances[(top + side) % len(distances), journals] for side in (-1, 1)]
    # between samples the squared distance is taken for a parabola
    bend = np.maximum(2.0 * farthest - beside[0] - beside[1], np.finfo(float).tiny)
    farthest = farthest + (beside[1] - beside[0]) ** 2 / (8.0 * bend)
    return float(np.sqrt(farthest.max()))


def largest_step(positions: Array, moves: Array, clearances: Array) -> float:
    """Part of a step, at most 1, that keeps every time sample off the clearance.

    Parameters are those of `greatest_eccentricity`; `moves` is what the step adds to `positions`.
    """
    c = clearances[::2]
    start, move = (one.reshape(len(positions), -1, 2) for one in (positions, moves))
    distance = np.linalg.norm(start, axis=-1)
    limit = np.minimum(distance + _ROOM * (c - distance), _NEAREST * c)
    # positive root s of |start + s move| = limit
    a = np.maximum((move**2).sum(axis=-1), np.finfo(float).tiny)
    b = (start * move).sum(axis=-1)
    gap = np.maximum(limit**2 - distance**2, 0.0)
    root = gap / np.maximum(b + np.sqrt(b * b + a * gap), np.finfo(float).tiny)
    return float(min(1.0, root.min()))
