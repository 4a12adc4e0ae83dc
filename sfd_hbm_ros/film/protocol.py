"""What the solver asks of a squeeze film, whatever its model."""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Motion: TypeAlias = tuple[Array, Array, Array]
"""Position [m], velocity [m/s] and acceleration [m/s2] of a journal at n times, (n, 2) each."""


@dataclass(frozen=True)
class FilmForces:
    """Film force on the journal and its exact derivatives at n states.

    Attributes
    ----------
    force : (n, 2) array
        Force on the journal along x and y [N].
    by_position, by_velocity, by_acceleration : (n, 2, 2) arrays
        ``[:, i, j]`` is the derivative of force i by component j of the position [N/m], the
        velocity [N s/m] and the acceleration [N s2/m].
    """

    force: Array
    by_position: Array
    by_velocity: Array
    by_acceleration: Array


class FilmModel(Protocol):
    """A squeeze film: its force on the journal as a function of the journal's motion.

    A model is a function of the state alone and is vectorised over states, so that the solver
    hands over all time samples of an orbit in one call.
    """

    @property
    def clearance(self) -> float:
        """Radial clearance c [m]."""

    @property
    def centred_damping(self) -> float:
        """Damping coefficient of small motion about the centre [N s/m]."""

    @property
    def centred_inertia(self) -> float:
        """Inertia coefficient of small motion about the centre [kg]."""

    def force(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Force on the journal [N], (n, 2), at positions [m], velocities and accelerations.

        Raises
        ------
        ValueError
            If a position lies on or outside the clearance circle.
        """

    def linearise(self, position: Array, velocity: Array, acceleration: Array) -> FilmForces:
        """Force and derivatives at the same states; raises as `force` does."""
