"""Which variants of a machine a study is of."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.machine import Machine, MachineError, override_all
from sfd_hbm_ros.study.distributions import Distribution
from sfd_hbm_ros.study.errors import StudyError

Array = NDArray[np.float64]

MAX_VARIANTS = 100_000
"""Hours of computation; a slip of the keyboard must not fill the memory with variants."""


@dataclass(frozen=True)
class Design:
    """A grid over some entries of a machine, and at each of its points the same random samples.

    Parameters
    ----------
    grid : mapping of str to sequence of float
        Values of the entries of the grid by their dotted paths; the last one varies fastest.
    scatter : mapping of str to Distribution
        Distributions of the entries that are sampled, independently, by their dotted paths.
    samples : int
        Number of samples; 1 where nothing is sampled.
    seed : int
        Seed of the random numbers. The first samples stay the same when there are more of them.

    Raises
    ------
    StudyError
        If nothing varies, an entry stands twice, or there are too many variants.
    """

    grid: Mapping[str, Sequence[float]]
    scatter: Mapping[str, Distribution]
    samples: int = 1
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.paths:
            raise StudyError("nothing varies: a study needs --vary or --sample")
        for path in self.grid.keys() & self.scatter.keys():
            raise StudyError(f"{path}: must be varied or sampled, not both")
        if len(self) > MAX_VARIANTS:
            raise StudyError(f"{len(self)} variants: must be {MAX_VARIANTS} at most")

    def __len__(self) -> int:
        return math.prod(len(values) for values in self.grid.values()) * self.samples

    @property
    def paths(self) -> tuple[str, ...]:
        """Dotted paths of the entries that vary, those of the grid first."""
        return (*self.grid, *self.scatter)

    @cached_property
    def values(self) -> Array:
        """Values of the entries, one row a variant, one column a path."""
        points = np.array(list(itertools.product(*self.grid.values())))
        random = np.random.default_rng(self.seed).random((self.samples, len(self.scatter)))
        columns = [
            one.quantile(column)
            for one, column in zip(self.scatter.values(), random.T, strict=True)
        ]
        samples = np.array(columns).reshape(len(columns), self.samples).T
        return np.hstack(
            [np.repeat(points, self.samples, axis=0), np.tile(samples, (len(points), 1))]
        )


def check_variants(design: Design, machine: Machine) -> None:
    """Check that every variant is a machine.

    Raises
    ------
    MachineError
        If one cannot be; the sentence names the variant, the key, the value and what is allowed.
    """
    for number, values in enumerate(design.values.tolist()):
        try:
            override_all(machine, dict(zip(design.paths, values, strict=True)))
        except MachineError as error:
            raise MachineError(f"variant {number}: {error}") from None
