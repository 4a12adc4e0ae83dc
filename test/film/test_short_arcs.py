"""Arcs so short that the closed forms of their integrals cancel."""

import numpy as np

from .states import paper_film, random_states


def test_force_over_short_arcs_is_smooth():
    """Between states 1e-9 apart the force is linear; what it is not is rounding."""
    film = paper_film()
    position, velocity, acceleration = (
        part[420:421] for part in random_states(film, 600, seed=2)
    )  # two arcs of 0.04 and 0.2 rad away from the thinnest film
    linear = film.linearise(position, velocity, acceleration)
    rng = np.random.default_rng(0)
    moves = 1e-9 * np.linalg.norm(position) * rng.uniform(-1.0, 1.0, (1000, 2))
    same = np.ones((1000, 1))
    force = film.force(position + moves, same * velocity, same * acceleration)
    rest = force - linear.force - moves @ linear.by_position[0].T
    assert np.abs(rest).max() < 1e-12 * np.linalg.norm(linear.force)
