"""As many time samples of a film as the spectrum of its force asks for."""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces, Motion
from sfd_hbm_ros.hbm.harmonics import MAX_SAMPLES, Harmonics

Array = NDArray[np.float64]

_FEWEST = 16
_RESOLVED = 1e-10  # part of the force at the end of the spectrum; what folds back is its square
_COARSE = 1e-4  # the part from which on the samples of the harmonics themselves are too few:
_DOUBLINGS = 5  # the film between a journal and the wall beside it needs these many more


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


def sampled(
    film: Film,
    harmonics: Harmonics,
    motion: Motion,
    motion_at: Callable[[Harmonics], Motion] | None = None,
) -> SampledFilm:
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
    motion_at : callable, optional
        The same motion at more samples. Near the clearance the film's force is so steep that
        those of `harmonics` do not resolve it; they are doubled further where this is given.
    """
    position, velocity, acceleration = motion
    *coarse, finest = _grids(harmonics)
    for grid in coarse:
        part = slice(None, None, grid.stride)
        some = position[part], velocity[part], acceleration[part]
        forces = film.linearise(*some)
        if _end(grid, forces) <= _RESOLVED:
            return SampledFilm(grid.harmonics, forces, some)
    forces = film.linearise(*motion)
    if motion_at is not None:
        for _ in range(_DOUBLINGS):
            if _end(finest, forces) <= _COARSE or 2 * finest.harmonics.samples > MAX_SAMPLES:
                break
            finest = _finer(finest.harmonics)
            motion = motion_at(finest.harmonics)
            forces = film.linearise(*motion)
    return SampledFilm(finest.harmonics, forces, motion)


def _end(grid: _Grid, forces: FilmForces) -> float:
    """Part of a force that lies at the end of the spectrum of its samples."""
    greatest = np.abs(forces.force).max()
    if not greatest > 0.0:
        return 0.0
    # Samples so few that no order is left beyond the motion's own tell nothing of the force's.
    return float(np.abs(grid.end @ forces.force).max() / greatest) if len(grid.end) else np.inf


@lru_cache(maxsize=64)
def _grids(harmonics: Harmonics) -> tuple[_Grid, ...]:
    """The coarsest first, each with twice the samples of the one before."""
    highest = harmonics.multiples[-1]
    fewest = max(_FEWEST, 4 * highest + 4, 2 * harmonics.highest * harmonics.revolutions + 1)
    grids: list[_Grid] = []
    samples, stride = harmonics.samples, 1
    while True:
        grids.insert(0, _grid(harmonics, samples, stride))
        if samples % 2 or samples // 2 < fewest:
            return tuple(grids)
        samples, stride = samples // 2, 2 * stride


@lru_cache(maxsize=64)
def _finer(harmonics: Harmonics) -> _Grid:
    """A grid of twice the samples."""
    return _grid(harmonics, 2 * harmonics.samples, 1)


def _grid(harmonics: Harmonics, samples: int, stride: int) -> _Grid:
    highest, last = harmonics.multiples[-1], samples // 2
    these = Harmonics(harmonics.highest, samples, harmonics.revolutions, harmonics.multiples)
    orders = np.arange(max(highest, last - 2 * highest) + 1, last + 1)
    angle = 2.0 * np.pi / samples * np.multiply.outer(orders, np.arange(samples))
    end = np.concatenate([np.cos(angle), np.sin(angle)]) * (2.0 / samples)
    return _Grid(these, stride, end)
