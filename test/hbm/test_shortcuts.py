"""What makes the solver fast against the slow way that it stands for."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, floquet, solve, stability
from sfd_hbm_ros.hbm.film_terms import FilmTerms
from sfd_hbm_ros.machine import override
from sfd_hbm_ros.rotor import reduce_model
from sfd_hbm_ros.rotor.reduction import _basis

from .machines import PAPER, random_machine

SPEED = 400.0


def product_at_every_sample(harmonics, film, motion):
    """Derivative of one film's force by the coefficients, summed up sample by sample."""
    f = film.linearise(*motion)
    slopes = f.by_position, f.by_velocity, f.by_acceleration
    total = np.zeros((harmonics.rows, 2, harmonics.rows, 2))
    for order, (slope, basis) in enumerate(zip(slopes, harmonics.bases, strict=True)):
        parts = "rt,tij,tc->ricj"
        total += SPEED**order * np.einsum(parts, harmonics.projection, slope, basis)
    return total


@pytest.mark.parametrize(
    "harmonics",
    [
        Harmonics(7),
        Harmonics(5, revolutions=2),
        Harmonics(9, multiples=(0, 1, 3, 4, 9)),
        Harmonics(7, samples=15),
    ],
    ids=["all", "halves", "group", "fewest samples"],
)
def test_jacobian_by_structure_equals_products_at_every_sample(harmonics):
    balance = HarmonicBalance(random_machine(7, dampers=2), harmonics)
    rng = np.random.default_rng(5)
    x = 0.1 * rng.uniform(-1.0, 1.0, (harmonics.rows, 4)) * balance.clearances
    matrix = np.zeros((x.size, x.size))
    terms = FilmTerms(harmonics, balance.films, SPEED, x)
    terms.subtract_derivative(matrix)
    blocks = -matrix.reshape(x.shape * 2)
    for journal, film in enumerate(balance.films):
        pair = slice(2 * journal, 2 * journal + 2)
        taken = terms._films[journal].harmonics  # with as many samples as the force asks for
        motion = [SPEED**k * (basis @ x[:, pair]) for k, basis in enumerate(taken.bases)]
        expected = product_at_every_sample(taken, film, motion)
        error = np.abs(blocks[:, pair, :, pair] - expected).max()
        assert error <= 1e-12 * np.abs(expected).max()
        blocks[:, pair, :, pair] = 0.0
    assert not blocks.any()  # films of different dampers do not feel each other


@pytest.mark.parametrize("rpm", [2000.0, 3900.0, 4150.0, 6000.0])
def test_multipliers_of_a_circle_equal_those_in_steps(rpm, monkeypatch):
    machine = override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4)
    balance = HarmonicBalance(machine, Harmonics(7))
    solution = solve(balance, rpm * np.pi / 30.0)
    at_once = stability(balance, solution).multipliers
    monkeypatch.setattr(floquet, "_is_circular", lambda solution: False)
    in_steps = stability(balance, solution).multipliers
    distances = np.abs(at_once[:, np.newaxis] - in_steps)
    assert max(distances.min(axis=0).max(), distances.min(axis=1).max()) < 1e-9


def test_orbit_under_gravity_is_no_circle():
    balance = HarmonicBalance(override(PAPER, "gravity", True), Harmonics(3))
    assert not floquet._is_circular(solve(balance, SPEED))


@pytest.mark.parametrize("anisotropic", [False, True])
def test_kept_modes_reduce_as_fresh_ones(anisotropic):
    """Any two frequencies share their modes up to the next power of two."""
    model = HarmonicBalance(random_machine(9, anisotropic=anisotropic), Harmonics(1)).model
    frequencies, _ = _basis(model, 2.0**14)
    for highest in (5000.0, 9000.0, 15000.0):
        reduced = reduce_model(model, highest)
        assert reduced.size == np.count_nonzero(frequencies <= highest) + 2
        modes = reduced.size - 2
        assert reduced.M[:modes, :modes] == pytest.approx(np.eye(modes), abs=1e-9)
        kept = np.sqrt(np.diag(reduced.K)[:modes])
        assert kept == pytest.approx(frequencies[:modes], rel=1e-6)
    assert reduce_model(model, 15000.0) is reduced
