"""Points of a branch, and why a branch ends."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Stop(Enum):
    """Why a branch ended; the value is a sentence."""

    RANGE = "the end of the parameter's range was reached"
    CLOSED = "the branch came back to its first point"
    JOINED = "the branch joined the one that it had left"
    CLEARANCE = "the orbit closes on the clearance"
    STEP = "the step became too short for the corrector to converge"
    POINTS = "the largest number of points was reached"
    ARC = "the branch became too long: it may go round and round"
    PROGRESS = "the points came no further: they creep up to a place that they do not reach"


@dataclass(frozen=True, eq=False)
class Point:
    """A point of a branch.

    Attributes
    ----------
    value : float
        The parameter.
    x : (n,) array
        Coefficients [m].
    tangent : (n + 1,) array
        Unit tangent along the branch, of the scaled unknowns; its last entry is the parameter's.
    eccentricity : float
        Greatest eccentricity at the time samples.
    iterations : int
        Corrector steps that it took.
    """

    value: float
    x: Array
    tangent: Array
    eccentricity: float
    iterations: int
