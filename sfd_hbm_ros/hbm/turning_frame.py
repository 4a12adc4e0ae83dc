"""Squeeze film forces in the frame that turns with the rotor.

A journal at p in that frame is at x = R p, with R the rotation by the rotor's angle W t, so that

    x' = R (p' + W J p),    x'' = R (p'' + 2 W J p' - W^2 p),

J turning by a right angle. The film is isotropic: turned motion gives the same force, turned.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces, FilmModel, Motion

Array = NDArray[np.float64]

_QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # the matrix J


def absolute(speed: float, motion: Motion) -> Motion:
    """Motion p(t) in a frame that turns at a speed [rad/s], as the fixed frame sees it.

    The vectors are turned back by R.
    """
    p, velocity, acceleration = motion
    return (
        p,
        velocity + speed * p @ _QUARTER.T,
        acceleration + 2.0 * speed * velocity @ _QUARTER.T - speed**2 * p,
    )


def slopes_by_turning(motion: Motion) -> tuple[Array, Array]:
    """What a faster frame adds to the rates of a motion in it, a unit of its speed.

    Part of the acceleration's change is the velocity's: J p turns with the frame. The derivative
    by the velocity that `TurningFilm` gives holds it already.
    """
    p, velocity, _ = motion
    return p @ _QUARTER.T, 2.0 * velocity @ _QUARTER.T


@dataclass(frozen=True)
class TurningFilm:
    """A film as a frame sees it that turns at a speed [rad/s]."""

    film: FilmModel
    speed: float

    def linearise(self, position: Array, velocity: Array, acceleration: Array) -> FilmForces:
        """Force and derivatives by the motion in the frame; see `FilmModel.linearise`."""
        speed = self.speed
        f = self.film.linearise(*absolute(speed, (position, velocity, acceleration)))
        return FilmForces(
            f.force,
            f.by_position + speed * f.by_velocity @ _QUARTER - speed**2 * f.by_acceleration,
            f.by_velocity + 2.0 * speed * f.by_acceleration @ _QUARTER,
            f.by_acceleration,
        )
