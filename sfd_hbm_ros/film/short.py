"""Short squeeze film with temporal fluid inertia (Eqs. 13 and 14), integrated exactly.

Across the length L of an open-ended land Eq. 13 gives a parabola of pressure, whose integral

    q(phi) = L^3/12 [12 mu (v.n)/h^3 + rho (a.n)/h],   n = (cos(phi), sin(phi)),  h = c - x.n,

pushes the journal along -n. In complex coordinates, z = x + i y, its moments over the arcs where q
is positive are the integrals of `integrals`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film.arcs import positive_arcs
from sfd_hbm_ros.film.frame import forces_of_integrals, seen_from_centres
from sfd_hbm_ros.film.integrals import arc_integrals
from sfd_hbm_ros.film.protocol import Array, FilmForces

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class ShortFilm:
    """Short-bearing squeeze film, with or without cavitation and fluid inertia.

    Parameters
    ----------
    radius, length, clearance : float
        Journal radius R, land length L and radial clearance c [m].
    viscosity : float
        Dynamic viscosity mu [Pa s].
    density : float
        Density rho of the fluid [kg/m3].
    cavitation : bool
        Cut off negative pressure (pi film when inertia is small); otherwise the full film.
    inertia : bool
        Include the temporal inertia of the fluid.
    """

    radius: float
    length: float
    clearance: float
    viscosity: float
    density: float
    cavitation: bool = True
    inertia: bool = True

    @property
    def centred_damping(self) -> float:
        """Small-motion damping pi mu R L^3/c^3 [N s/m], half of it with cavitation."""
        return np.pi * self._arc_fraction * self._viscous / self.clearance**3

    @property
    def centred_inertia(self) -> float:
        """Small-motion inertia pi rho R L^3/(12 c) [kg], half of it with cavitation."""
        return np.pi * self._arc_fraction * self._inertial / self.clearance

    @property
    def _arc_fraction(self) -> float:
        return 0.5 if self.cavitation else 1.0

    @property
    def _viscous(self) -> float:
        return self.viscosity * self.radius * self.length**3

    @property
    def _inertial(self) -> float:
        density = self.density if self.inertia else 0.0
        return density * self.radius * self.length**3 / 12.0

    def force(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Force on the journal [N], (n, 2); see `FilmModel.force`."""
        return self.linearise(position, velocity, acceleration).force

    def linearise(self, position: Array, velocity: Array, acceleration: Array) -> FilmForces:
        """Force and its exact derivatives; see `FilmModel.linearise`.

        The zeros of the pressure move with the state, but the pressure vanishes there, so that
        the arcs can be held fixed in every derivative.
        """
        x, x1, x2 = (
            np.array(part, dtype=float, order="C") for part in (position, velocity, acceleration)
        )
        distance = np.empty(len(x))
        line, v, a = seen_from_centres(x, x1, x2, distance)
        eps = distance / self.clearance
        if not (eps < 1.0).all():
            raise ValueError(
                f"eccentricity {np.max(eps):.6g} is not inside the clearance, it must be below 1"
            )
        integrals = arc_integrals(eps, *self._arcs(eps, v, a))
        force, slopes = forces_of_integrals(
            line, v, a, integrals, self._viscous, self._inertial, self.clearance
        )
        return FilmForces(force, *slopes)

    def _arcs(
        self, eps: Array, v: ComplexArray, a: ComplexArray
    ) -> tuple[Array, NDArray[np.int64]]:
        """Ends of each state's arcs, and their number."""
        if not self.cavitation:
            ends = np.tile([0.0, 2.0 * np.pi], (len(eps), 1, 1))
            return ends, np.ones(len(eps), dtype=np.int64)
        return positive_arcs(eps, v, self._inertial * self.clearance**2 / self._viscous * a)
