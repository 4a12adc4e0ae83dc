"""Arcs so short that the closed forms of their integrals cancel."""

import numpy as np

from sfd_hbm_ros.film import arcs

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


def test_angles_of_roots_are_those_of_eigenvalues():
    """Of polynomials whose roots lie on the unit circle or in pairs across it."""
    rng = np.random.default_rng(4)
    half = rng.standard_normal((2000, 3)) + 1j * rng.standard_normal((2000, 3))
    middle = rng.standard_normal((2000, 1)) + 0j
    polynomials = np.hstack([half, middle, half[:, ::-1].conj()])
    angles = np.empty((2000, 6))
    found = arcs._angles_of_roots(polynomials, angles)
    assert found.mean() > 0.99
    for polynomial, own in zip(polynomials[found], angles[found], strict=True):
        roots = np.roots(polynomial)
        gaps = np.abs(roots[:, np.newaxis] / np.abs(roots[:, np.newaxis]) - np.exp(1j * own))
        assert gaps.min(axis=0).max() < 1e-6
        assert gaps.min(axis=1).max() < 1e-6
