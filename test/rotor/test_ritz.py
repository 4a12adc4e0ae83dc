"""Ritz vectors against dense algebra: the error bound, the order of convergence, exhaustion."""

import numpy as np
import pytest
from scipy.linalg import solve_triangular

from sfd_hbm_ros.rotor.flexibility import Flexibility, apart, beside
from sfd_hbm_ros.rotor.ritz import _Space, ritz

SIZE, HALF, SHAFTS, COLUMNS = 30, 2, 3, 2
POLE = 1.0  # z of the lowest


def hermitian_bands(rng, real):
    bands = rng.standard_normal((SIZE, 2 * HALF + 1))
    if not real:
        bands = bands + 1j * rng.standard_normal(bands.shape)
    return bands


def dense(bands):
    matrix = np.zeros((SIZE, SIZE), dtype=bands.dtype)
    for j in range(SIZE):
        for i in range(max(0, j - HALF), min(SIZE, j + HALF + 1)):
            matrix[i, j] = bands[j, HALF + i - j]
    return matrix


class Problem:
    """Random stiffness, inertias and forces, the inertias scaled to the lowest pole."""

    def __init__(self, real):
        rng = np.random.default_rng(3)
        self.bands = hermitian_bands(rng, real)
        self.bands[:, HALF] += 4.0 * HALF
        K = dense(self.bands)
        self.K = 0.5 * (K + K.conj().T)
        inertias = [dense(hermitian_bands(rng, real)) for _ in range(SHAFTS)]
        inertias = [B + B.conj().T for B in inertias]
        self.B = np.stack([B / np.abs(self.eigenvalues(B)).max() / POLE for B in inertias])
        self.forces = rng.standard_normal((SHAFTS, SIZE, COLUMNS))
        if not real:
            self.forces = self.forces + 1j * rng.standard_normal(self.forces.shape)
        self.flexibility = Flexibility(self.bands)

    def eigenvalues(self, B):
        L = np.linalg.cholesky(self.K)
        half = solve_triangular(L, B, lower=True)
        return np.linalg.eigvalsh(solve_triangular(L, half.conj().T, lower=True))

    def inertia(self, vectors):
        return self.B @ vectors

    def response(self, z):
        solved = np.linalg.solve(self.K - z * self.B, self.forces)
        return self.forces.conj().swapaxes(1, 2) @ solved

    def space(self, blocks):
        """The space of so many blocks, and the sizes of the forces."""
        start = self.flexibility.down(self.forces)
        sizes = np.linalg.norm(start, axis=1, keepdims=True)
        space = _Space(start / sizes)
        for _ in range(blocks):
            assert space.grow()
            image = self.inertia(self.flexibility.up(space.latest))
            space.extend(self.flexibility.down(image))
        return space, sizes


def response_of(values, loads, z):
    return loads.conj().swapaxes(1, 2) @ (loads / (1.0 - z * values)[..., np.newaxis])


each_kind = pytest.mark.parametrize("real", [True, False], ids=["real", "complex"])


@each_kind
def test_factor_solves_what_it_should(real):
    problem = Problem(real)
    solved = problem.flexibility.up(problem.flexibility.down(problem.forces))
    np.testing.assert_allclose(problem.K @ solved, problem.forces, atol=1e-12)
    np.testing.assert_array_equal(apart(beside(problem.forces), SHAFTS), problem.forces)


@each_kind
@pytest.mark.parametrize("z", [0.04, 0.81, 2.3])
def test_response_equals_the_dense_one(real, z):
    problem = Problem(real)
    found = response_of(*ritz(problem.flexibility, problem.inertia, problem.forces, 1.6), z)
    np.testing.assert_allclose(found, problem.response(z), rtol=1e-10, atol=1e-12)


@each_kind
@pytest.mark.parametrize("blocks", [2, 4, 6, 8])
def test_error_stays_within_the_bound(real, blocks):
    """|R_i| |R_j| / d with the static flexibility as unit."""
    problem, speed = Problem(real), 0.9
    space, sizes = problem.space(blocks)
    values, loads, _ = space.eigenvalues()
    error = response_of(values, loads * sizes, speed**2) - problem.response(speed**2)
    d = min(np.abs(1.0 - speed**2 * problem.eigenvalues(B)).min() for B in problem.B)
    bound = space.left_over(speed) ** 2 / d
    assert np.abs(error / (sizes * sizes.swapaxes(1, 2))).max() <= bound + 1e-14
    assert bound < 1e3 * 0.5**blocks  # and the bound itself falls


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_error_is_of_the_order_of_twice_the_blocks(blocks):
    """As many powers of z are exact: two for each block."""
    problem = Problem(True)
    space, sizes = problem.space(blocks)
    values, loads, _ = space.eigenvalues()
    z = np.array([0.04, 0.06, 0.09])
    errors = [
        np.abs(response_of(values, loads * sizes, one) - problem.response(one)).max() for one in z
    ]
    order = np.polyfit(np.log(z), np.log(errors), 1)[0]
    assert order == pytest.approx(2 * blocks, abs=0.15)


def test_exhausted_space_is_exact_and_ends():
    """Forces on the first of two parts that do not touch never reach the other."""
    K = np.diag(np.arange(1.0, 11.0))
    coupled = np.diag(np.ones(9), 1)
    coupled[4, 5] = 0.0
    B = (coupled + coupled.T)[np.newaxis]
    forces = np.zeros((1, 10, 2))
    forces[0, 0] = 1.0, 2.0  # the same twice
    found = ritz(Flexibility(np.diag(K)[:, np.newaxis]), lambda x: B @ x, forces, 100.0)
    assert found.values.shape == (1, 5)
    exact = forces[0].T @ np.linalg.solve(K - 7.0 * B[0], forces[0])
    np.testing.assert_allclose(response_of(*found, 7.0)[0], exact, rtol=1e-12)


def test_stiffness_that_holds_nothing_is_refused():
    with pytest.raises(np.linalg.LinAlgError):
        Flexibility(np.array([[0.0, 1.0, -1.0], [-1.0, 1.0, 0.0]]))
