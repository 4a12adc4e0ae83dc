"""Small disturbances of a response over one period of it: y' = A y with periodic A.

Their solution is a product of matrix exponentials (Magnus series of fourth order, Blanes et al.
2009, Phys. Rep. 470, 151), exact where A is constant.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from sfd_hbm_ros.film import FilmForces
from sfd_hbm_ros.rotor import RotorModel

Array = NDArray[np.float64]

_STIFF = 10.0  # norm of the Magnus series' second term beyond which the series is of no use
_LOBATTO = np.array([[2.0, -4.0, 2.0], [2.0, 5.0, -1.0], [2.0, 8.0, 2.0]]) / 12.0


class _Terms(NamedTuple):
    """What a film adds to stiffness, damping and mass at n samples, (n, 2, 2) each."""

    stiffness: Array
    damping: Array
    mass: Array


def rates(
    rotor: RotorModel,
    films: Sequence[FilmForces],
    speed: float,
    frequency: float,
    turning: float = 0.0,
) -> Array:
    """Matrices A of y' = A y over a period, y = (q, dq/dangle), the angle being frequency * time.

    Parameters
    ----------
    rotor : RotorModel
        The rotor, of m coordinates.
    films : sequence of FilmForces
        Those of each damper at n samples of the period; in a turning frame, as it sees them.
    speed : float
        Rotor speed [rad/s].
    frequency : float
        Frequency of the response [rad/s].
    turning : float
        Speed at which the frame of q turns [rad/s].

    Returns
    -------
    (n + 1, 2m, 2m) array, the last matrix being the first.
    """
    w, m = frequency, rotor.size
    mass, damping, stiffness = w * w * rotor.M, w * (rotor.C + speed * rotor.G), rotor.K
    terms = [
        _Terms(-film.by_position, -w * film.by_velocity, -w * w * film.by_acceleration)
        for film in films
    ]
    if turning:
        stiffness, damping = _turned(stiffness, damping, mass, turning / w)
        terms = [_Terms(*_turned(*term, turning / w), term.mass) for term in terms]
    rows, film_mass = _film_rows(rotor, terms)
    journals = rotor.journals.ravel()
    # the films add to the journals' rows alone: the mass is inverted by Woodbury's formula
    rotor_part = np.linalg.solve(mass, np.hstack([stiffness, damping]))
    reach = np.linalg.solve(mass, np.eye(m)[:, journals])
    film_part = np.linalg.solve(
        np.eye(len(journals)) + film_mass @ reach[journals],
        rows - film_mass @ rotor_part[journals],
    )
    matrices = np.zeros((len(rows) + 1, 2 * m, 2 * m))
    matrices[:, :m, m:] = np.eye(m)
    matrices[:-1, m:] = -rotor_part - reach @ film_part
    matrices[-1] = matrices[0]
    return matrices


def _film_rows(rotor: RotorModel, terms: Sequence[_Terms]) -> tuple[Array, Array]:
    """What the films add to the journals' n rows: by (q, q'), (samples, n, 2m), and by q''."""
    samples, n, m = len(terms[0].stiffness), 2 * len(terms), rotor.size
    rows, mass = np.zeros((samples, n, 2 * m)), np.zeros((samples, n, n))
    for damper, (term, (x, y)) in enumerate(zip(terms, rotor.journals, strict=True)):
        own = slice(2 * damper, 2 * damper + 2)
        rows[:, own, x : y + 1] = term.stiffness
        rows[:, own, m + x : m + y + 1] = term.damping
        mass[:, own, own] = term.mass
    return rows, mass


def _turned(stiffness: Array, damping: Array, mass: Array, ratio: float) -> tuple[Array, Array]:
    """Stiffness and damping as a frame sees them that turns at a multiple of the frequency.

    q = R p, q' = R (p' + r J p), q'' = R (p'' + 2 r J p' - r^2 p), with matrices (..., m, m).
    """
    return (
        stiffness + ratio * _times_quarter(damping) - ratio**2 * mass,
        damping + 2.0 * ratio * _times_quarter(mass),
    )


def _times_quarter(matrices: Array) -> Array:
    """The matrices (..., m) times the rotation J of every pair of coordinates by a right angle."""
    product = np.empty_like(matrices)
    product[..., ::2], product[..., 1::2] = matrices[..., 1::2], -matrices[..., ::2]
    return product


def monodromy(rates: Array, period: float) -> Array:
    """Map of a disturbance y over one period, (2m, 2m).

    Parameters
    ----------
    rates : (2 steps + 1, 2m, 2m) array
        Matrices A at the beginning, in the middle and at the end of each step.
    period : float
        The period, an angle [rad].
    """
    first, middle, last = rates[:-1:2], rates[1::2], rates[2::2]
    h = period / len(first)
    commutators = h * h / 12.0 * (first @ last - last @ first)
    if np.linalg.norm(commutators, axis=(1, 2)).max() > _STIFF:
        parts = _lobatto_steps(h, np.stack([first, middle, last], axis=1))
    else:
        parts = expm(h / 6.0 * (first + 4.0 * middle + last) - commutators)
    product = np.eye(rates.shape[1])
    for step in parts:
        product = step @ product
    return product


def _lobatto_steps(h: float, rates: Array) -> Array:
    """Maps over steps of length h by Lobatto IIIC with three stages, (steps, 2m, 2m).

    It is of fourth order too, and L-stable (Hairer and Wanner 1996, Solving ODEs II, IV.5).

    Parameters
    ----------
    h : float
        Length of a step [rad].
    rates : (steps, 3, 2m, 2m) array
        Matrices A at the beginning, the middle and the end of each.
    """
    steps, stages, size, _ = rates.shape
    blocks = h * np.einsum("ij,sjkl->sikjl", _LOBATTO, rates)
    matrix = np.eye(stages * size) - blocks.reshape(steps, stages * size, stages * size)
    start = np.tile(np.eye(size), (steps, stages, 1))
    maps: Array = np.linalg.solve(matrix, start)[:, -size:]
    return maps
