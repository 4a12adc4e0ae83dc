"""How an entry of the machine file scatters, by the quantiles of its distribution."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

Array = NDArray[np.float64]


class Distribution(Protocol):
    """A distribution of one number."""

    def quantile(self, probability: Array) -> Array:
        """Values below which the number lies with the given probabilities; the same shape."""


@dataclass(frozen=True)
class Normal:
    """The normal distribution.

    Parameters
    ----------
    mean, deviation : float
        Mean and standard deviation, in the entry's unit.

    Raises
    ------
    ValueError
        If one is not finite, or the deviation is not positive.
    """

    mean: float
    deviation: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.mean) and 0.0 < self.deviation < math.inf):
            raise ValueError("must be normal(MEAN,SD) of finite numbers with SD above 0")

    def quantile(self, probability: Array) -> Array:
        """Return quantiles."""
        return self.mean + self.deviation * np.asarray(ndtri(probability))


@dataclass(frozen=True)
class Uniform:
    """The uniform distribution.

    Parameters
    ----------
    lowest, highest : float
        Its ends, in the entry's unit.

    Raises
    ------
    ValueError
        If one is not finite, or the lowest is not below the highest.
    """

    lowest: float
    highest: float

    def __post_init__(self) -> None:
        if not -math.inf < self.lowest < self.highest < math.inf:
            raise ValueError("must be uniform(A,B) of finite numbers with A below B")

    def quantile(self, probability: Array) -> Array:
        """Return quantiles."""
        return self.lowest + (self.highest - self.lowest) * probability


@dataclass(frozen=True)
class LogNormal:
    """The distribution of a positive number whose logarithm is normally distributed.

    Parameters
    ----------
    median : float
        Median, in the entry's unit.
    deviation : float
        Standard deviation of the natural logarithm; where it is small, that of the number over
        its mean.

    Raises
    ------
    ValueError
        If one is not finite and positive.
    """

    median: float
    deviation: float

    def __post_init__(self) -> None:
        if not (0.0 < self.median < math.inf and 0.0 < self.deviation < math.inf):
            raise ValueError("must be lognormal(MEDIAN,S) of finite numbers above 0")

    def quantile(self, probability: Array) -> Array:
        """Return quantiles."""
        return self.median * np.exp(self.deviation * np.asarray(ndtri(probability)))


DISTRIBUTIONS: dict[str, Callable[[float, float], Distribution]] = {
    "normal": Normal,
    "uniform": Uniform,
    "lognormal": LogNormal,
}
"""The distributions there are, by the names they go by on the command line."""
