"""Squeeze film forces and their exact derivatives, one model a file, one protocol."""

from collections.abc import Callable

from sfd_hbm_ros.film.protocol import FilmForces, FilmModel, Motion
from sfd_hbm_ros.film.short import ShortFilm
from sfd_hbm_ros.machine import Damper

__all__ = ["FILMS", "FilmForces", "FilmModel", "Motion", "ShortFilm", "film_of"]


def _short(damper: Damper) -> ShortFilm:
    return ShortFilm(
        radius=0.5 * damper.diameter,
        length=damper.length,
        clearance=damper.clearance,
        viscosity=damper.viscosity,
        density=damper.density,
        cavitation=damper.film.cavitation,
        inertia=damper.film.inertia,
    )


#: What makes the film of a damper, by the name of its model in the machine file.
FILMS: dict[str, Callable[[Damper], FilmModel]] = {"short": _short}


def film_of(damper: Damper) -> FilmModel:
    """Film of a damper, by the model that its settings name."""
    return FILMS[damper.film.model](damper)
