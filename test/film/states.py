"""Films and journal states that the film's tests share."""

import numpy as np

from sfd_hbm_ros.film.short import ShortFilm


def paper_film(**options) -> ShortFilm:
    """Film of the paper's Table 1."""
    return ShortFilm(0.0381, 0.0254, 2.54e-4, 0.028, 865.0, **options)


def random_states(film: ShortFilm, n: int, seed: int):
    """Position, velocity and acceleration, each (n, 2), with eccentricities from 0 to 0.98.

    The acceleration spans the range from negligible to dominant fluid inertia, so that one,
    two and three arcs of positive pressure occur.
    """
    rng = np.random.default_rng(seed)
    eps = np.concatenate(
        [
            rng.uniform(0.0, 0.98, n // 2),
            1.0 - 10.0 ** rng.uniform(np.log10(0.02), -0.1, n // 4),
            10.0 ** rng.uniform(-9.0, -1.0, n - n // 2 - n // 4),
        ]
    )
    eps[:3] = 0.0
    angle = rng.uniform(0.0, 2.0 * np.pi, n)
    x = film.clearance * eps[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    v = 0.1 * rng.normal(size=(n, 2))
    a = 0.1 * rng.normal(size=(n, 2)) * 10.0 ** rng.uniform(1.0, 5.0, (n, 1))
    opposed = slice(0, n, 7)  # squeeze and pull against each other: the arcs divide
    a[opposed] = -v[opposed] * 10.0 ** rng.uniform(2.5, 4.5, (len(v[opposed]), 1))
    return x, v, a
