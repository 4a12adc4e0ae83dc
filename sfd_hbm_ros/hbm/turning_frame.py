"""Squeeze film forces in the frame that turns with the rotor.

A journal at p in that frame is at x = R p, with R the rotation by the rotor's angle W t, so that

    x' = R (p' + W J p),    x'' = R (p'' + 2 W J p' - W^2 p),

J turning by a right angle. The film is isotropic: turned motion gives the same force, turned.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces, FilmModel

Array = NDArray[np.float64]

_QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # the matrix J


class TurningMotion(NamedTuple):
    """Motion p(t) of a journal as a turning frame sees it: (samples, 2) arrays."""

    p: Array
    velocity: Array
    acceleration: Array

    def absolute(self, speed: float) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration in the fixed frame, turned back by R."""
        p, velocity, acceleration = self
        return (
            p,
            velocity + speed * p @ _QUARTER.T,
            acceleration + 2.0 * speed * velocity @ _QUARTER.T - speed**2 * p,
        )


def turning_forces(film: FilmModel, speed: float, motion: TurningMotion) -> FilmForces:
    """Film forces on a journal and their derivatives by its motion in the turning frame.

    Parameters
    ----------
    film : FilmModel
        The film.
    speed : float
        Speed W of the frame [rad/s].
    motion : TurningMotion
        The motion in the frame [m].
    """
    f = film.linearise(*motion.absolute(speed))
    return FilmForces(
        f.force,
        f.by_position + speed * f.by_velocity @ _QUARTER - speed**2 * f.by_acceleration,
        f.by_velocity + 2.0 * speed * f.by_acceleration @ _QUARTER,
        f.by_acceleration,
    )


def slope_by_turning(film: FilmModel, speed: float, motion: TurningMotion) -> Array:
    """Derivative of the film forces by the speed of the frame [N s], (samples, 2)."""
    f = film.linearise(*motion.absolute(speed))
    turned = motion.p @ _QUARTER.T
    coriolis = 2.0 * (motion.velocity @ _QUARTER.T - speed * motion.p)
    slope: Array = np.einsum("tij,tj->ti", f.by_velocity, turned)
    slope += np.einsum("tij,tj->ti", f.by_acceleration, coriolis)
    return slope
