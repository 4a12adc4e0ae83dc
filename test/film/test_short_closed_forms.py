"""The short film against published closed forms."""

import numpy as np
import pytest

from .states import paper_film

OMEGA = 400.0  # whirl speed [rad/s]


def centred_circle(film, eps):
    """State on a circular centred orbit, at the angle 0."""
    radius = eps * film.clearance
    return (
        np.array([[radius, 0.0]]),
        np.array([[0.0, radius * OMEGA]]),
        np.array([[-radius * OMEGA**2, 0.0]]),
    )


@pytest.mark.parametrize("eps", [1e-6, 0.1, 0.5, 0.9, 0.99])
def test_circular_centred_orbit_of_the_pi_film(eps):
    """Gunter, Barrett and Allaire 1977 (J. Lubr. Technol. 99, 57), short bearing, pi film."""
    film = paper_film(inertia=False)
    common = film.viscosity * film.radius * film.length**3 / film.clearance**3
    stiffness = 2.0 * common * OMEGA * eps / (1.0 - eps**2) ** 2
    damping = 0.5 * np.pi * common / (1.0 - eps**2) ** 1.5
    [[radial, tangential]] = film.force(*centred_circle(film, eps))
    radius = eps * film.clearance
    assert radial == pytest.approx(-stiffness * radius, rel=1e-10)
    assert tangential == pytest.approx(-damping * OMEGA * radius, rel=1e-10)


@pytest.mark.parametrize("eps", [0.0, 0.3, 0.8])
def test_full_film_has_no_radial_viscous_force(eps):
    """The pressure of the uncavitated circular orbit is odd about the line of centres."""
    film = paper_film(cavitation=False, inertia=False)
    [[radial, tangential]] = film.force(*centred_circle(film, eps))
    assert abs(radial) <= 1e-12 * abs(tangential)
    damping = np.pi * film.viscosity * film.radius * film.length**3 / film.clearance**3
    expected = -damping / (1.0 - eps**2) ** 1.5 * OMEGA * eps * film.clearance
    assert tangential == pytest.approx(expected, rel=1e-12, abs=1e-300)


def test_small_motion_coefficients_of_the_paper_damper():
    """San Andres, Modern Lubrication Theory, Notes 13: 3351.5 N s/m and 0.557 kg."""
    film = paper_film(cavitation=False)
    centre = np.zeros((1, 2))
    forces = film.linearise(centre, centre, centre)
    assert -forces.by_velocity[0] == pytest.approx(3351.5 * np.eye(2), abs=0.05)
    assert -forces.by_acceleration[0] == pytest.approx(0.557 * np.eye(2), abs=5e-4)
    assert forces.by_position[0] == pytest.approx(np.zeros((2, 2)), abs=1e-9)
    assert film.centred_damping == pytest.approx(-forces.by_velocity[0, 0, 0], rel=1e-12)
    assert film.centred_inertia == pytest.approx(-forces.by_acceleration[0, 0, 0], rel=1e-12)


def test_cavitation_halves_the_small_motion_coefficients():
    full, half = paper_film(cavitation=False), paper_film()
    assert half.centred_damping == pytest.approx(0.5 * full.centred_damping, rel=1e-15)
    state = centred_circle(half, 1e-7)
    [[_, tangential]] = half.force(*state)
    assert tangential == pytest.approx(-half.centred_damping * state[1][0, 1], rel=1e-6)


def test_force_turns_with_the_state():
    film = paper_film()
    rng = np.random.default_rng(4)
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    state = (
        0.6 * film.clearance * rng.uniform(-1, 1, (50, 2)),
        rng.normal(size=(50, 2)),
        1e3 * rng.normal(size=(50, 2)),
    )
    turned = film.force(*(part @ turn.T for part in state))
    assert np.allclose(turned, film.force(*state) @ turn.T, rtol=1e-11, atol=0.0)


def test_journal_at_rest_feels_nothing():
    film = paper_film()
    position = np.array([[0.5 * film.clearance, 0.0]])
    assert np.array_equal(film.force(position, 0 * position, 0 * position), np.zeros((1, 2)))


def test_position_outside_the_clearance_is_refused():
    film = paper_film()
    position = np.array([[film.clearance, 0.0]])
    with pytest.raises(ValueError, match=r"eccentricity 1 is not inside the clearance"):
        film.force(position, position, position)
