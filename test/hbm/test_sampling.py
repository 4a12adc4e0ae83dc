"""Fewer time samples, where the spectrum allows, against all of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.hbm.sampling import sampled

from .machines import PAPER

SPEED = 400.0
HARMONICS = Harmonics(7)
FILM = film_of(PAPER.dampers[0])


def motion(amplitudes):
    """Sampled motion of complex amplitudes (orders, 2), of the clearance."""
    x = HARMONICS.coefficients(FILM.clearance * np.asarray(amplitudes, dtype=complex))
    return tuple(SPEED**k * (basis @ x) for k, basis in enumerate(HARMONICS.bases))


def circle(eccentricity, offset=0.0):
    """A circle about a point beside the centre."""
    amplitudes = np.zeros((8, 2), dtype=complex)
    amplitudes[0] = 0.0, -offset
    amplitudes[1] = eccentricity, -1j * eccentricity
    return motion(amplitudes)


def difference(path):
    """Of the coefficients of force and derivatives from those with all samples, relative."""
    film, all_samples = sampled(FILM, HARMONICS, path), FILM.linearise(*path)
    errors = []
    for name in ("force", "by_position", "by_velocity", "by_acceleration"):
        few = film.harmonics.projection @ getattr(film.forces, name).reshape(
            film.harmonics.samples, -1
        )
        full = HARMONICS.projection @ getattr(all_samples, name).reshape(128, -1)
        errors.append(np.abs(few - full).max() / np.abs(full).max())
    return max(errors)


@pytest.mark.parametrize(
    ("path", "samples"),
    [
        (circle(0.0), 32),
        (circle(0.5), 32),
        (circle(0.98), 32),
        (circle(0.4, 0.1), 64),
        (circle(0.5, 0.4), 128),
    ],
    ids=["at rest", "circle", "near the clearance", "beside the centre", "far beside it"],
)
def test_samples_are_as_many_as_the_spectrum_asks_for(path, samples):
    assert sampled(FILM, HARMONICS, path).harmonics.samples == samples


@pytest.mark.parametrize("offset", [0.02, 0.1, 0.2, 0.3, 0.4])
@pytest.mark.parametrize("eccentricity", [0.1, 0.3, 0.5])
def test_fewer_samples_give_the_same_coefficients(eccentricity, offset):
    assert difference(circle(eccentricity, offset)) < 1e-11


@given(
    st.lists(st.integers(0, 7), min_size=1, max_size=3),
    st.integers(0, 2**32 - 1),
    st.floats(0.02, 0.9),
)
@settings(max_examples=300, deadline=None)
def test_orders_far_apart_are_not_missed(orders, seed, reach):
    """Forces of a few orders have spectra with wide gaps."""
    rng = np.random.default_rng(seed)
    amplitudes = np.zeros((8, 2), dtype=complex)
    for order in (1, *orders):
        forward, backward = rng.normal(size=2) * rng.choice([1e-6, 1e-2, 1.0], 2)
        amplitudes[order] += forward + backward, -1j * (forward - backward)
    amplitudes[0] = amplitudes[0].real
    position, _, _ = motion(amplitudes)
    farthest = np.linalg.norm(position, axis=1).max() / FILM.clearance
    assert difference(motion(amplitudes * reach / farthest)) < 1e-9


def test_odd_or_few_samples_are_all_taken():
    harmonics = Harmonics(7, samples=15)
    x = harmonics.coefficients(0.3 * FILM.clearance * np.ones((8, 2)) / 8.0 + 0j)
    path = tuple(SPEED**k * (basis @ x) for k, basis in enumerate(harmonics.bases))
    assert sampled(FILM, harmonics, path).harmonics.samples == 15
