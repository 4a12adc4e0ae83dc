"""Short squeeze film with temporal fluid inertia (Eqs. 13 and 14), integrated exactly.

Across the length L of an open-ended land Eq. 13 gives a parabola of pressure, whose integral

    q(phi) = L^3/12 [12 mu (v.n)/h^3 + rho (a.n)/h],   n = (cos(phi), sin(phi)),  h = c - x.n,

pushes the journal along -n. In complex coordinates, z = x + i y, its moments over the arcs where q
is positive are the integrals of `integrals`.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film.arcs import Arcs, full_circle, positive_arcs
from sfd_hbm_ros.film.integrals import ArcIntegrals
from sfd_hbm_ros.film.protocol import Array, FilmForces

ComplexArray = NDArray[np.complex128]


class _State(NamedTuple):
    """Eccentricity, and the motion seen from the line of centres, whose direction is `line`."""

    eps: Array
    line: ComplexArray
    v: ComplexArray
    a: ComplexArray


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
        state = self._state(position, velocity, acceleration)
        integrals = ArcIntegrals(state.eps, self._arcs(state))
        return _as_xy(self._complex_force(state, *integrals.of_force()))

    def linearise(self, position: Array, velocity: Array, acceleration: Array) -> FilmForces:
        """Force and its exact derivatives; see `FilmModel.linearise`.

        The zeros of the pressure move with the state, but the pressure vanishes there, so that
        the arcs can be held fixed in every derivative.
        """
        state = self._state(position, velocity, acceleration)
        integrals = ArcIntegrals(state.eps, self._arcs(state))
        j30, j32, j10, j12 = integrals.of_force()
        j41, j43, j21, j23 = integrals.of_gradient()
        c, mu, rho = self.clearance, self._viscous, self._inertial
        _, line, v, a = state
        by_conj = 0.75 * mu / c**4 * (v * j41 + v.conj() * j43)
        by_conj += 0.25 * rho / c**2 * (a * j21 + a.conj() * j23)
        by_z = 0.75 * mu / c**4 * (v * j41.conj() + v.conj() * j41)
        by_z += 0.25 * rho / c**2 * (a * j21.conj() + a.conj() * j21)
        turned = line * line
        return FilmForces(
            _as_xy(self._complex_force(state, j30, j32, j10, j12)),
            _as_matrix(-by_z, -by_conj * turned),
            _as_matrix(-0.5 * mu / c**3 * j30, -0.5 * mu / c**3 * j32 * turned),
            _as_matrix(-0.5 * rho / c * j10, -0.5 * rho / c * j12 * turned),
        )

    def _state(self, position: Array, velocity: Array, acceleration: Array) -> _State:
        z = _as_complex(position)
        distance = np.abs(z)
        eps = distance / self.clearance
        if not np.all(eps < 1.0):
            raise ValueError(
                f"eccentricity {np.max(eps):.6g} is not inside the clearance, it must be below 1"
            )
        centred = distance == 0  # any direction will do
        line = np.where(centred, 1.0, z / np.where(centred, 1.0, distance)) + 0j
        back = line.conj()
        return _State(eps, line, back * _as_complex(velocity), back * _as_complex(acceleration))

    def _arcs(self, state: _State) -> Arcs:
        if not self.cavitation:
            return full_circle(len(state.eps))
        scale = self._inertial * self.clearance**2 / self._viscous
        return positive_arcs(state.eps, state.v, scale * state.a)

    def _complex_force(
        self,
        state: _State,
        j30: ComplexArray,
        j32: ComplexArray,
        j10: ComplexArray,
        j12: ComplexArray,
    ) -> ComplexArray:
        viscous = self._viscous / self.clearance**3 * (j30 * state.v + j32 * state.v.conj())
        inertial = self._inertial / self.clearance * (j10 * state.a + j12 * state.a.conj())
        force: ComplexArray = -0.5 * state.line * (viscous + inertial)
        return force


def _as_complex(pairs: Array) -> ComplexArray:
    z: ComplexArray = pairs[:, 0] + 1j * pairs[:, 1]
    return z


def _as_xy(z: ComplexArray) -> Array:
    return np.stack([z.real, z.imag], axis=-1)


def _as_matrix(by_z: ComplexArray, by_conj: ComplexArray) -> Array:
    """Real (n, 2, 2) derivative from those by z and by conj(z) (Wirtinger)."""
    total, difference = by_z + by_conj, by_z - by_conj
    row_x = np.stack([total.real, -difference.imag], axis=-1)
    row_y = np.stack([total.imag, difference.real], axis=-1)
    return np.stack([row_x, row_y], axis=-2)
