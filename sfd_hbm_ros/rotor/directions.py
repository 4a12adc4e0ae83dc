"""The sense in which a vibration mode runs round its orbits."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray, SparseArray


class Direction(StrEnum):
    """Sense of a mode's orbits: forward is from x to y, as the rotor turns; planar is a line."""

    FORWARD = "forward"
    BACKWARD = "backward"
    PLANAR = "planar"


def senses(M: SparseArray, shapes: ComplexArray) -> RealArray:
    """Return the sense of modes, weighing each place by the mass that moves there.

    Parameters
    ----------
    M : (N, N) sparse array
        Mass matrix, x and y interleaved.
    shapes : (N, modes) complex array
        Shapes q, which move as Re(q exp(i w t)).

    Returns
    -------
    (modes,) array
        1 for circles run forward, -1 for circles run backward, 0 for lines.
    """
    mass = M[0::2, 0::2]
    x, y = shapes[0::2], shapes[1::2]
    swept = -2.0 * np.sum(x.conj() * (mass @ y), axis=0).imag
    moved = np.sum(x.conj() * (mass @ x) + y.conj() * (mass @ y), axis=0).real
    return np.asarray(swept / moved)


def direction(sense: float) -> Direction:
    """Name a sense; rounding gives a line a sense of its own, far below 1e-6."""
    if abs(sense) < 1e-6:
        return Direction.PLANAR
    return Direction.FORWARD if sense > 0.0 else Direction.BACKWARD
