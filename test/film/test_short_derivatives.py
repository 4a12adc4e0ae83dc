"""The short film's derivatives against sixth-order differences of its force."""

import numpy as np
import pytest

from .states import paper_film, random_states

STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))


def arcs_of(film, x, v, a):
    """Number of sign changes of the pressure around the circumference, (n,)."""
    phi = np.linspace(0.0, 2.0 * np.pi, 4001)
    n = np.stack([np.cos(phi), np.sin(phi)])
    inertia = film.density if film.inertia else 0.0
    sign = np.sign(
        12.0 * film.viscosity * (v @ n) + inertia * (a @ n) * (film.clearance - x @ n) ** 2
    )
    return np.count_nonzero(sign[:, :-1] * sign[:, 1:] < 0, axis=1)


def steps_of(film, state):
    """Difference steps of position, velocity and acceleration, each (n,)."""
    x, v, a = state
    room = film.clearance - np.linalg.norm(x, axis=1)
    return [2e-4 * size for size in (room, np.linalg.norm(v, axis=1), np.linalg.norm(a, axis=1))]


def shifted(state, kind, axis, shift):
    moved = list(state)
    moved[kind] = state[kind].copy()
    moved[kind][:, axis] += shift
    return moved


def differences(film, state, kind, axis, step):
    """Sixth-order difference of the force by one component of the state, (n, 2)."""
    total = np.zeros_like(state[0])
    for multiple, weight in STENCIL:
        ahead = film.force(*shifted(state, kind, axis, multiple * step))
        behind = film.force(*shifted(state, kind, axis, -multiple * step))
        total += weight * (ahead - behind)
    return total / step[:, None]


def far_from_switching(film, state, kind, step):
    """Where no arc of positive pressure appears or vanishes within ten stencils."""
    arcs = arcs_of(film, *state)
    return np.all(
        [
            arcs_of(film, *shifted(state, kind, axis, side * 30.0 * step)) == arcs
            for axis in (0, 1)
            for side in (-1, 1)
        ],
        axis=0,
    )


@pytest.mark.parametrize("inertia", [True, False])
@pytest.mark.parametrize("cavitation", [True, False])
def test_derivatives_equal_differences(cavitation, inertia):
    film = paper_film(cavitation=cavitation, inertia=inertia)
    state = random_states(film, 600, seed=2)
    forces = film.linearise(*state)
    exact = (forces.by_position, forces.by_velocity, forces.by_acceleration)
    for kind, step in enumerate(steps_of(film, state)):
        estimate = np.stack(
            [differences(film, state, kind, axis, step) for axis in (0, 1)], axis=-1
        )
        smooth = far_from_switching(film, state, kind, step)
        assert np.mean(smooth) > 0.8
        error = np.linalg.norm(estimate - exact[kind], axis=(1, 2))
        scale = np.linalg.norm(exact[kind], axis=(1, 2))
        # what a difference cannot resolve: the rounding of the force itself
        rounding = 1e-12 * np.linalg.norm(forces.force, axis=1) / step
        assert np.max((error / (1e-6 * scale + rounding))[smooth]) < 1.0


def test_force_of_linearise_is_the_force():
    film = paper_film()
    state = random_states(film, 200, seed=3)
    assert np.array_equal(film.linearise(*state).force, film.force(*state))
