"""The frame of the line of centres, in which a short film is integrated: the ways in and out.

In complex coordinates, z = x + i y, the integrals of `integrals` are the film's force and its
derivatives by the motion and its conjugate (Wirtinger).
"""

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film.protocol import Array
from sfd_hbm_ros.kernels import kernel, part

ComplexArray = NDArray[np.complex128]


@part
def _as_matrix(matrix: Array, by_z: complex, by_conj: complex) -> None:
    """Set the real derivative (2, 2) from those by z and by conj(z)."""
    total, difference = by_z + by_conj, by_z - by_conj
    matrix[0, 0], matrix[0, 1] = total.real, -difference.imag
    matrix[1, 0], matrix[1, 1] = total.imag, difference.real


@kernel(
    "UniTuple(complex128[::1], 3)(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])"
)
def seen_from_centres(
    position: Array, velocity: Array, acceleration: Array, distance: Array
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Direction of the line of centres, and the motion along it and across.

    Parameters
    ----------
    position, velocity, acceleration : (n, 2) arrays
        States [m], [m/s], [m/s2].
    distance : (n,) array
        Gets the distance from the centre [m].

    Returns
    -------
    Unit vectors of the lines, then velocities and accelerations turned back by them, (n,) each.
    """
    n = len(position)
    line = np.empty(n, dtype=np.complex128)
    v, a = np.empty_like(line), np.empty_like(line)
    for i in range(n):
        z = complex(position[i, 0], position[i, 1])
        distance[i] = abs(z)
        line[i] = z / distance[i] if distance[i] > 0.0 else 1.0  # any direction will do
        back = line[i].conjugate()
        v[i] = back * complex(velocity[i, 0], velocity[i, 1])
        a[i] = back * complex(acceleration[i, 0], acceleration[i, 1])
    return line, v, a


@kernel(
    "Tuple((float64[:, ::1], float64[:, :, :, ::1]))"
    "(complex128[::1], complex128[::1], complex128[::1], complex128[:, ::1],"
    " float64, float64, float64)"
)
def forces_of_integrals(
    line: ComplexArray,
    v: ComplexArray,
    a: ComplexArray,
    integrals: ComplexArray,
    viscous: float,
    inertial: float,
    c: float,
) -> tuple[Array, Array]:
    """Force of the film and its derivatives.

    Parameters
    ----------
    line, v, a : (n,) complex arrays
        What `seen_from_centres` returns.
    integrals : (n, 8) complex array
        What `arc_integrals` returns.
    viscous, inertial : float
        mu R L^3 [Pa s m4] and rho R L^3/12 [kg m].
    c : float
        Radial clearance [m].

    Returns
    -------
    Forces (n, 2) [N] and derivatives (3, n, 2, 2) by position, velocity and acceleration.
    """
    n = len(line)
    force, slopes = np.empty((n, 2)), np.empty((3, n, 2, 2))
    mu, rho = -0.5 * viscous / c**3, -0.5 * inertial / c
    for i in range(n):
        turned = line[i] * line[i]
        va, aa, vc, ac = v[i], a[i], v[i].conjugate(), a[i].conjugate()
        j30, j32, j10, j12 = integrals[i, 0], integrals[i, 1], integrals[i, 2], integrals[i, 3]
        j41, j43, j21, j23 = integrals[i, 4], integrals[i, 5], integrals[i, 6], integrals[i, 7]
        total = line[i] * (mu * (j30 * va + j32 * vc) + rho * (j10 * aa + j12 * ac))
        force[i, 0], force[i, 1] = total.real, total.imag
        by_z = 1.5 * mu / c * (va * j41.conjugate() + vc * j41)
        by_z += 0.5 * rho / c * (aa * j21.conjugate() + ac * j21)
        by_conj = 1.5 * mu / c * (va * j41 + vc * j43) + 0.5 * rho / c * (aa * j21 + ac * j23)
        _as_matrix(slopes[0, i], by_z, by_conj * turned)
        _as_matrix(slopes[1, i], mu * j30, mu * j32 * turned)
        _as_matrix(slopes[2, i], rho * j10, rho * j12 * turned)
    return force, slopes
