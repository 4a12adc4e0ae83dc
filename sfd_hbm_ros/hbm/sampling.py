"""As many time samples of a film as the spectrum of its force asks for."""

from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces, Motion
from sfd_hbm_ros.hbm.harmonics import Harmonics

Array = NDArray[np.float64]

_FEWEST = 16
_RESOLVED = 1e-10  # part of the force at the end of the spectrum; what folds back is its square


class Film(Protocol):
    """A film as some frame sees it."""

    def linearise(self, position: Array, velocity: Array, acceleration: Array) -> FilmForces:
        """See `FilmModel.linearise`."""


class SampledFilm(NamedTuple):
    """A film along its journal's motion, at evenly spaced times of a period.

    Attributes
    ----------
    harmonics : Harmonics
        The motion's harmonics, with the number of samples that was taken.
    forces : FilmForces
        Force and derivatives at the samples.
    motion : Motion
        The motion there.
    """

    harmonics: Harmonics
    forces: FilmForces
    motion: Motion


class _Grid(NamedTuple):
    harmonics: Harmonics
    stride: int  # of all samples, those that this grid takes
    end: Array  # from samples to the orders at the end of their spectrum


def sampled(film: Film, harmonics: Harmonics, motion: Motion) -> SampledFilm:
    """Evaluate a film along a motion.

    The samples are doubled, up to those of `harmonics`, until the force has no part left at the
    end of their spectrum. The orders looked at there are as many as those that the motion can
    have between them, so that a force whose orders lie far apart is not missed.

    Parameters
    ----------
    film : Film
        The film.
    harmonics : Harmonics
        Of the motion.
    motion : Motion
        The motion at the samples of `harmonics`.
    """
    position, velocity, acceleration = motion
    *coarse, finest = _grids(harmonics)
    for grid in coarse:
        part = slice(None, None, grid.stride)
        some = position[part], velocity[part], acceleration[part]
        forces = film.linearise(*some)
        if np.abs(grid.end @ forces.force).max() <= _RESOLVED * np.abs(forces.force).max():
            return SampledFilm(grid.harmonics, forces, some)
    return SampledFilm(finest.harmonics, film.linearise(*motion), motion)


@lru_cache(maxsize=64)
def _grids(harmonics: Harmonics) -> tuple[_Grid, ...]:
    """The coarsest first, each with twice the samples of the one before."""
    highest = harmonics.multiples[-1]
    fewest = max(_FEWEST, 4 * highest + 4, 2 * harmonics.highest * harmonics.revolutions + 1)
    grids: list[_Grid] = []
    samples, stride = harmonics.samples, 1
    while True:
        these = Harmonics(harmonics.highest, samples, harmonics.revolutions, harmonics.multiples)
        last = samples // 2
        orders = np.arange(max(highest, last - 2 * highest) + 1, last + 1)
        angle = 2.0 * np.pi / samples * np.multiply.outer(orders, np.arange(samples))
        end = np.concatenate([np.cos(angle), np.sin(angle)]) * (2.0 / samples)
        grids.insert(0, _Grid(these, stride, end))
        if samples % 2 or samples // 2 < fewest:
            return tuple(grids)
        samples, stride = samples // 2, 2 * stride
