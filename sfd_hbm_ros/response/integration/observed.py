"""Jumps as a run in time shows them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.integration.transient import Transient

Array = NDArray[np.float64]

SIDE = 0.0025
"""Part of itself by which the speed changes on each side of a jump that is looked at."""

LEAST = 0.05
"""Least difference of the eccentricities on both sides that is a jump."""

FEWEST = 10
"""Revolutions that a side must have."""

_SHORTEST = 0.25  # part of a side that there must be near the ends of a run


@dataclass(frozen=True)
class ObservedJump:
    """An abrupt change of the greatest eccentricity of any damper.

    Attributes
    ----------
    direction : Direction
        Whether it came in a run-up or a coast-down.
    speed : float
        Rotor speed in its middle [rad/s].
    eccentricity_from, eccentricity_to : float
        Mean of the revolutions' greatest eccentricities on both sides.
    """

    direction: Direction
    speed: float
    eccentricity_from: float
    eccentricity_to: float


def observed_jumps(transient: Transient) -> list[ObservedJump]:
    """Jumps of a run, in the order in which they happened.

    Beside each revolution the eccentricities are averaged over the last ones before and the next
    ones after, while the speed changes by `SIDE` of itself. Where both means differ by `LEAST` or
    more, and most, there is a jump. A resonance that is passed less steeply is none, and neither
    is a beat, whose mean does not change. At a constant speed there are no jumps, and none can be
    told from a beat where the speed changes by `SIDE` within `FEWEST` revolutions.
    """
    direction = transient.ramp.direction
    speed, eccentricity = transient.speed, transient.worst_eccentricity
    if direction is None or len(speed) < 2:
        return []
    before, after = _sides(speed, eccentricity)
    change = np.abs(after - before)
    found = []
    for stretch in _stretches(change >= LEAST):
        i = stretch[np.argmax(change[stretch])]
        middle = float(0.5 * (speed[i] + speed[i + 1]))
        found.append(ObservedJump(direction, middle, float(before[i]), float(after[i])))
    return found


def _sides(speed: Array, eccentricity: Array) -> tuple[Array, Array]:
    """Mean eccentricity before and after each pair of neighbouring revolutions of m, (m - 1,).

    Both are NaN where there is too little to average: in a fast run, and near its ends.
    """
    m = len(speed)
    split = np.arange(1, m)
    width = (SIDE * speed[1:] / np.abs(np.diff(speed))).astype(int)
    first, last = np.maximum(split - width, 0), np.minimum(split + width, m)
    short = np.minimum(split - first, last - split) < np.maximum(_SHORTEST * width, FEWEST)
    total = np.concatenate([[0.0], np.cumsum(eccentricity)])
    with np.errstate(invalid="ignore"):  # sides of no revolution are among the short ones
        before = (total[split] - total[first]) / (split - first)
        after = (total[last] - total[split]) / (last - split)
    return np.where(short, np.nan, before), np.where(short, np.nan, after)


def _stretches(holds: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Indices of each unbroken stretch in which a condition holds."""
    indices = np.flatnonzero(holds)
    parts = np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1)
    return [part for part in parts if part.size]
