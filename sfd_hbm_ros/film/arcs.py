"""The arcs on which the pressure of a short film is positive.

In the frame of the line of centres the pressure has the sign of

    g(theta) = Re(conj(W) exp(i theta)),   W(theta) = v + (1 - eps cos(theta))^2 a,

with the velocity v and the acceleration a scaled to the same unit (Eq. 13). Without fluid inertia
W is constant and the arc is the half circle about v. With it g is a trigonometric polynomial of
degree 3: it has two zeros as long as the direction of W turns slower than theta, and up to six
otherwise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_TURN_LIMIT = 0.95  # of the rate of theta: below 1 there are two zeros, nearer 1 Newton is slow
_VANISHING = 1e-12  # of |v|^2: a W below it may be a rounded zero, where it turns at once
_ITERATIONS = 6
_LAST_STEP = 1e-6  # of Newton's method [rad]: the zero is then good to about its square


class Arcs(NamedTuple):
    """Arcs of the circumference and the states that they belong to.

    Attributes
    ----------
    ends : (2, m) array
        Start and end of each arc, as angles from the line of centres [rad].
    state : (m,) integer array
        Index of the arc's state.
    """

    ends: Array
    state: NDArray[np.intp]


def full_circle(n: int) -> Arcs:
    """One arc of the whole circumference for each of n states."""
    return Arcs(np.stack([np.zeros(n), np.full(n, 2.0 * np.pi)]), np.arange(n))


def positive_arcs(eps: Array, v: ComplexArray, a: ComplexArray) -> Arcs:
    """Arcs of positive pressure.

    Parameters
    ----------
    eps : (n,) array
        Eccentricity.
    v, a : (n,) complex arrays
        Velocity and scaled acceleration a rho c^2/(12 mu), both [m/s], in the frame of the
        line of centres, as x + i y.

    Returns
    -------
    The arcs, none or up to five for a state (neighbouring arcs may touch).
    """
    v = np.where((v == 0) & (a == 0), 1.0, v)  # at rest any arc gives no force
    ends, single = _single_arc(eps, v, a)
    if single.all():
        return Arcs(ends, np.arange(len(eps)))
    rest = np.flatnonzero(~single)
    more = _several_arcs(eps[rest], v[rest], a[rest])
    first = np.flatnonzero(single)
    return Arcs(np.hstack([ends[:, first], more.ends]), np.concatenate([first, rest[more.state]]))


def _direction(eps: Array, v: ComplexArray, a: ComplexArray, theta: Array) -> ComplexArray:
    w: ComplexArray = v + (1.0 - eps * np.cos(theta)) ** 2 * a
    return w


def _single_arc(eps: Array, v: ComplexArray, a: ComplexArray) -> tuple[Array, NDArray[np.bool_]]:
    """The ends (2, n) of the only arc, and for which states that is proven and converged."""
    side = np.array([[-1.0], [1.0]])
    theta = np.arctan2(v.imag, v.real) + 0.5 * np.pi * side
    if not a.any():
        return theta, np.ones(len(eps), dtype=bool)
    cross = v.real * a.imag - v.imag * a.real
    dot = v.real * a.real + v.imag * a.imag
    with np.errstate(all="ignore"):  # states that fail here are told apart by `single`
        nearest = np.clip(-dot / np.abs(a) ** 2, (1.0 - eps) ** 2, (1.0 + eps) ** 2)
        slowest = np.abs(v + np.where(a == 0, 0.0, nearest) * a) ** 2
        single = _steepest_thickness(eps) * np.abs(cross) < _TURN_LIMIT * slowest
        single &= slowest > _VANISHING * np.abs(v) ** 2
        for _ in range(_ITERATIONS):
            cosine, sine = np.cos(theta), np.sin(theta)
            h = 1.0 - eps * cosine
            wx, wy = v.real + h * h * a.real, v.imag + h * h * a.imag
            normal, tangential = wx * cosine + wy * sine, wy * cosine - wx * sine
            off = np.arctan2(side * normal, -side * tangential)
            turn = 2.0 * eps * h * sine * cross / (wx * wx + wy * wy)
            theta = theta + off / (1.0 - turn)
            last = np.abs(off).max(axis=0)
            if np.all(last[single] < _LAST_STEP):
                break
        single &= last < _LAST_STEP
    # both ends are known modulo a turn: the end is the first after the start
    theta[1] = theta[0] + np.mod(theta[1] - theta[0], 2.0 * np.pi)
    return theta, single


def _steepest_thickness(eps: Array) -> Array:
    """Greatest derivative of (1 - eps cos(theta))^2 by theta."""
    cosine = -2.0 * eps / (1.0 + np.sqrt(1.0 + 8.0 * eps**2))
    steepest: Array = 2.0 * eps * (1.0 - eps * cosine) * np.sqrt(1.0 - cosine**2)
    return steepest


def _several_arcs(eps: Array, v: ComplexArray, a: ComplexArray) -> Arcs:
    """Every interval between neighbouring zeros, closed where the pressure is not positive.

    The zeros are the angles of all six roots of the polynomial in exp(i theta). Roots off the
    unit circle only divide an interval, so that no root has to be judged real or not.
    """
    c3 = eps**2 / 8.0 * a.conj()
    c2 = -0.5 * eps * a.conj()
    c1 = 0.5 * (v.conj() + (1.0 + 0.5 * eps**2) * a.conj() + 0.25 * eps**2 * a)
    c0 = -eps * a.real + 0j
    lower = np.stack([c2, c1, c0, c1.conj(), c2.conj(), c3.conj()], axis=-1)
    companion = np.zeros((len(eps), 6, 6), dtype=complex)
    companion[:, 0, :] = -lower / c3[:, None]
    companion[:, np.arange(1, 6), np.arange(5)] = 1.0
    start = np.sort(np.angle(np.linalg.eigvals(companion)), axis=-1)
    end = np.hstack([start[:, 1:], start[:, :1] + 2.0 * np.pi])
    middle = 0.5 * (start + end)
    w = _direction(eps[:, None], v[:, None], a[:, None], middle)
    positive = (w.conj() * np.exp(1j * middle)).real > 0
    return Arcs(np.stack([start[positive], end[positive]]), np.nonzero(positive)[0])
