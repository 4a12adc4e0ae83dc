"""The films' terms in the harmonic balance equations, by alternating frequency and time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces, FilmModel
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.jacobian import sampled_products, subtract_products

Array = NDArray[np.float64]


class FilmTerms:
    """Forces of all films at one motion of their journals, in the coefficients.

    Parameters
    ----------
    harmonics : Harmonics
        The motion's harmonics.
    films : sequence of FilmModel
        The film of each journal.
    speed : float
        Rotor speed [rad/s].
    x : (rows, n) array
        Coefficients of the n = 2 coordinates a film [m].
    """

    def __init__(
        self, harmonics: Harmonics, films: Sequence[FilmModel], speed: float, x: Array
    ) -> None:
        self._harmonics, self._speed = harmonics, speed
        position, velocity, acceleration = (
            speed**order * (basis @ x) for order, basis in enumerate(harmonics.bases)
        )
        columns = [slice(2 * journal, 2 * journal + 2) for journal in range(len(films))]
        self._rates = [(velocity[:, pair], acceleration[:, pair]) for pair in columns]
        self._forces: list[FilmForces] = [
            film.linearise(position[:, pair], *rates)
            for film, pair, rates in zip(films, columns, self._rates, strict=True)
        ]

    def force(self) -> Array:
        """Coefficients of the forces [N], (rows, n)."""
        samples = np.concatenate([film.force for film in self._forces], axis=1)
        force: Array = self._harmonics.projection @ samples
        return force

    def subtract_derivative(self, matrix: Array) -> None:
        """Subtract the derivative of `force` by the coefficients from a (rows n, rows n) array."""
        harmonics, n = self._harmonics, 2 * len(self._forces)
        blocks = matrix.reshape(harmonics.rows, n, harmonics.rows, n)
        multiples = np.array(harmonics.multiples)
        frequencies = np.array(self._speed * harmonics.orders, dtype=float)
        for journal, film in enumerate(self._forces):
            slopes = np.array([film.by_position, film.by_velocity, film.by_acceleration])
            spectra = harmonics.spectrum @ slopes.reshape(3, harmonics.samples, 4)
            spectra = spectra.reshape(3, 2, -1, 4)
            subtract_products(blocks, 2 * journal, spectra, multiples, frequencies)

    def slope_by_speed(self) -> Array:
        """Derivative of `force` by the speed at the same coefficients [N s], (rows, n)."""
        changes = [
            sampled_products(
                film.by_velocity,
                velocity / self._speed,
                film.by_acceleration,
                (2.0 / self._speed) * acceleration,
            )
            for film, (velocity, acceleration) in zip(self._forces, self._rates, strict=True)
        ]
        slope: Array = self._harmonics.projection @ np.concatenate(changes, axis=1)
        return slope
