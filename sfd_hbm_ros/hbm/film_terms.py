"""The films' terms in the harmonic balance equations, by alternating frequency and time."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import Motion
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.jacobian import sampled_products, subtract_products
from sfd_hbm_ros.hbm.sampling import Film, SampledFilm, sampled

Array = NDArray[np.float64]


class FilmTerms:
    """Forces of all films at one motion of their journals, in the coefficients.

    Parameters
    ----------
    harmonics : Harmonics
        The motion's harmonics.
    films : sequence of Film
        The film of each journal.
    frequency : float
        Frequency of which the harmonics are multiples, such as the rotor speed [rad/s].
    x : (rows, n) array
        Coefficients of the n = 2 coordinates a film [m].
    """

    def __init__(
        self, harmonics: Harmonics, films: Sequence[Film], frequency: float, x: Array
    ) -> None:
        self._harmonics, self._frequency = harmonics, frequency
        columns = (slice(2 * journal, 2 * journal + 2) for journal in range(len(films)))

        def motion(group: Harmonics, pair: slice) -> Motion:
            position, velocity, acceleration = (
                frequency**order * (basis @ x[:, pair]) for order, basis in enumerate(group.bases)
            )
            return position, velocity, acceleration

        self._films: list[SampledFilm] = [
            sampled(film, harmonics, motion(harmonics, pair), partial(motion, pair=pair))
            for film, pair in zip(films, columns, strict=True)
        ]

    def force(self) -> Array:
        """Coefficients of the forces [N], (rows, n)."""
        return np.concatenate(
            [film.harmonics.projection @ film.forces.force for film in self._films], axis=1
        )

    def subtract_derivative(self, matrix: Array) -> None:
        """Subtract the derivative of `force` by the coefficients from a (rows n, rows n) array."""
        harmonics, n = self._harmonics, 2 * len(self._films)
        blocks = matrix.reshape(harmonics.rows, n, harmonics.rows, n)
        multiples, frequencies = harmonics.indices, self._frequency * harmonics.indices
        frequencies = frequencies / harmonics.revolutions
        for journal, film in enumerate(self._films):
            f, samples = film.forces, film.harmonics.samples
            slopes = np.array([f.by_position, f.by_velocity, f.by_acceleration])
            spectra = film.harmonics.spectrum @ slopes.reshape(3, samples, 4)
            spectra = spectra.reshape(3, 2, -1, 4)
            subtract_products(blocks, 2 * journal, spectra, multiples, frequencies)

    def slope_by_frequency(self) -> Array:
        """Derivative of `force` by the frequency at the same coefficients [N s], (rows, n)."""
        w = self._frequency
        return self.slope_by_rates(lambda motion: (motion[1] / w, (2.0 / w) * motion[2]))

    def slope_by_rates(self, changes: Callable[[Motion], tuple[Array, Array]]) -> Array:
        """Derivative of `force` by what changes a motion's rates but not its positions, (rows, n).

        Parameters
        ----------
        changes : callable
            Derivatives of velocity and acceleration, (samples, 2) each, of a motion.
        """
        parts = []
        for film in self._films:
            velocity, acceleration = changes(film.motion)
            slopes = film.forces.by_velocity, film.forces.by_acceleration
            change = sampled_products(slopes[0], velocity, slopes[1], acceleration)
            parts.append(film.harmonics.projection @ change)
        return np.concatenate(parts, axis=1)


class LatestTerms:
    """Film terms as a function of the unknowns x that keeps the latest.

    Residual, Jacobian and slopes are asked for one after another at the same x.
    """

    def __init__(self, terms_at: Callable[[Array], FilmTerms]) -> None:
        self._terms_at = terms_at
        self._latest: tuple[Array, FilmTerms] | None = None

    def __call__(self, x: Array) -> FilmTerms:
        """The terms at x."""
        if self._latest is None or not np.array_equal(self._latest[0], x):
            self._latest = x.copy(), self._terms_at(x)
        return self._latest[1]
