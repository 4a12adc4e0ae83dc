"""The arcs on which the pressure of a short film is positive.

In the frame of the line of centres the pressure has the sign of

    g(theta) = Re(conj(W) exp(i theta)),   W(theta) = v + (1 - eps cos(theta))^2 a,

with the velocity v and the acceleration a scaled to the same unit (Eq. 13). Without fluid inertia
W is constant and the arc is the half circle about v. With it g is a trigonometric polynomial of
degree 3: it has two zeros as long as the direction of W turns slower than theta, and up to six
otherwise.
"""

import math

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.kernels import kernel, part

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_ZEROS = 6
_TURN_LIMIT = 0.95  # of the rate of theta: below 1 there are two zeros, nearer 1 Newton is slow
_VANISHING = 1e-12  # of |v|^2: a W below it may be a rounded zero, where it turns at once
_ITERATIONS = 8
_LEADING = 1e-6  # part of the largest coefficient below which a polynomial has roots far away
_ABERTH = 60  # iterations of Aberth's method; a dozen where no roots are close
_ROUNDING = 1e-13  # of its last step
_LAST_STEP = 1e-6  # of Newton's method [rad]: the zero is then good to about its square


@part
def _thickness_squared(eps: float, cosine: float) -> float:
    return (1.0 - eps * cosine) ** 2


@part
def _single_arc(eps: float, v: complex, a: complex) -> tuple[bool, float, float]:
    """Whether there is one arc for certain, and its ends."""
    if v == 0.0 and a == 0.0:
        v = 1.0 + 0.0j  # at rest any arc gives no force
    if a == 0.0:
        middle = math.atan2(v.imag, v.real)
        return True, middle - 0.5 * math.pi, middle + 0.5 * math.pi
    cross = v.real * a.imag - v.imag * a.real
    nearest = -(v.real * a.real + v.imag * a.imag) / _square(a)
    nearest = min(max(nearest, _thickness_squared(eps, 1.0)), _thickness_squared(eps, -1.0))
    slowest = _square(v + nearest * a)
    if _steepest_thickness(eps) * abs(cross) >= _TURN_LIMIT * slowest:
        return False, math.nan, math.nan
    if slowest <= _VANISHING * _square(v):
        return False, math.nan, math.nan
    start, end = _zero(eps, v, a, -1.0), _zero(eps, v, a, 1.0)
    if end < start:  # both are known modulo a turn: the end is the first after the start
        end += 2.0 * math.pi
    return math.isfinite(start) and math.isfinite(end), start, end


@part
def _square(z: complex) -> float:
    return z.real * z.real + z.imag * z.imag


@part
def _steepest_thickness(eps: float) -> float:
    """Greatest derivative of (1 - eps cos(theta))^2 by theta."""
    cosine = -2.0 * eps / (1.0 + math.sqrt(1.0 + 8.0 * eps**2))
    return 2.0 * eps * (1.0 - eps * cosine) * math.sqrt(1.0 - cosine**2)


@part
def _zero(eps: float, v: complex, a: complex, side: float) -> float:
    """Zero of g a quarter turn before (-1) or after (+1) W, or nan if none was found.

    Newton's method turns the unit vector (x, y) at the angle theta by a rational rotation: by the
    angle between it and the direction sought, over 1 - d(arg W)/d(theta).
    """
    w = v + a  # at a thickness of 1
    if w == 0.0:
        w = v
    cross = v.real * a.imag - v.imag * a.real
    size = math.sqrt(_square(w))
    x, y = -side * w.imag / size, side * w.real / size
    for _ in range(_ITERATIONS):
        h = 1.0 - eps * x
        w = v + h * h * a
        square = _square(w)
        normal, tangential = side * (w.real * x + w.imag * y), side * (w.real * y - w.imag * x)
        turn = 2.0 * eps * h * y * cross / square
        tangent = normal / ((math.sqrt(square) + tangential) * (1.0 - turn))  # of half the angle
        cosine = (1.0 - tangent * tangent) / (1.0 + tangent * tangent)
        sine = 2.0 * tangent / (1.0 + tangent * tangent)
        x, y = x * cosine - y * sine, y * cosine + x * sine
        if 2.0 * abs(tangent) < _LAST_STEP:
            return math.atan2(y, x)
    return math.nan


@kernel("boolean[::1](float64[::1], complex128[::1], complex128[::1], float64[:, :, ::1])")
def _single_arcs(eps: Array, v: ComplexArray, a: ComplexArray, ends: Array) -> NDArray[np.bool_]:
    """Set the ends of each state's only arc; for which states that is certain."""
    single = np.empty(len(eps), dtype=np.bool_)
    for i in range(len(eps)):
        single[i], ends[i, 0, 0], ends[i, 0, 1] = _single_arc(eps[i], v[i], a[i])
    return single


@part
def _corrections(p: ComplexArray, z: ComplexArray, step: ComplexArray) -> float:
    """Set Aberth's corrections of all roots of a polynomial; the largest, relative to its root."""
    largest = 0.0
    for i in range(_ZEROS):
        value, slope = p[0], 0.0j
        for k in range(1, _ZEROS + 1):
            slope = slope * z[i] + value
            value = value * z[i] + p[k]
        if value == 0.0:
            step[i] = 0.0
            continue
        inverse = slope / value
        for j in range(_ZEROS):
            if j != i:
                inverse -= 1.0 / (z[i] - z[j])
        step[i] = 1.0 / inverse
        part = abs(step[i]) / abs(z[i])
        if not part <= largest:  # so that what is not a number shows
            largest = part
    return largest


@kernel("boolean[::1](complex128[:, ::1], float64[:, ::1])")
def _angles_of_roots(polynomials: ComplexArray, angles: Array) -> NDArray[np.bool_]:
    """Set the angles of each polynomial's six roots by Aberth's method; for which it was exact.

    It takes a fifth of the time of the eigenvalues of companion matrices (6 against 31 us).
    """
    found = np.zeros(len(polynomials), dtype=np.bool_)
    z, step = np.empty(_ZEROS, dtype=np.complex128), np.empty(_ZEROS, dtype=np.complex128)
    for n in range(len(polynomials)):
        p = polynomials[n]
        if abs(p[0]) < _LEADING * np.abs(p).max():
            continue  # roots far away
        for i in range(_ZEROS):
            angle, radius = 0.4 + i * 2.0 * math.pi / _ZEROS, 0.9 + 0.25 * (i % 2)
            z[i] = complex(radius * math.cos(angle), radius * math.sin(angle))
        for _ in range(_ABERTH):
            largest = _corrections(p, z, step)
            for i in range(_ZEROS):
                z[i] -= step[i]
            if largest <= _ROUNDING:
                found[n] = True
                break
        for i in range(_ZEROS):
            angles[n, i] = math.atan2(z[i].imag, z[i].real)
    return found


def positive_arcs(eps: Array, v: ComplexArray, a: ComplexArray) -> tuple[Array, NDArray[np.int64]]:
    """Arcs of positive pressure of n states.

    Parameters
    ----------
    eps : (n,) array
        Eccentricity.
    v, a : (n,) complex arrays
        Velocity and scaled acceleration a rho c^2/(12 mu), both [m/s], in the frame of the
        line of centres, as x + i y.

    Returns
    -------
    Start and end of each state's arcs (n, 6, 2), as angles from the line of centres [rad], and
    their number (n,), which may be 0. Neighbouring arcs may touch.
    """
    ends, counts = np.empty((len(eps), _ZEROS, 2)), np.ones(len(eps), dtype=np.int64)
    single = _single_arcs(eps, v, a, ends)
    if not single.all():
        rest = np.flatnonzero(~single)
        ends[rest], counts[rest] = _several_arcs(eps[rest], v[rest], a[rest])
    return ends, counts


def _several_arcs(eps: Array, v: ComplexArray, a: ComplexArray) -> tuple[Array, NDArray[np.int64]]:
    """Every interval between neighbouring zeros on which the pressure is positive.

    The zeros are the angles of all six roots of the polynomial in exp(i theta). Roots off the
    unit circle only divide an interval, so that no root has to be judged real or not.
    """
    c3 = eps**2 / 8.0 * a.conj()
    c3[c3 == 0.0] = np.finfo(float).tiny  # velocity and acceleration cancel at the very centre
    c2 = -0.5 * eps * a.conj()
    c1 = 0.5 * (v.conj() + (1.0 + 0.5 * eps**2) * a.conj() + 0.25 * eps**2 * a)
    c0 = -eps * a.real + 0j
    lower = np.stack([c2, c1, c0, c1.conj(), c2.conj(), c3.conj()], axis=-1)
    polynomials = np.concatenate([c3[:, np.newaxis], lower], axis=-1)
    angles = np.empty((len(eps), _ZEROS))
    rest = np.flatnonzero(~_angles_of_roots(polynomials, angles))
    if rest.size:
        companion = np.zeros((rest.size, _ZEROS, _ZEROS), dtype=complex)
        companion[:, 0, :] = -lower[rest] / c3[rest, np.newaxis]
        companion[:, np.arange(1, _ZEROS), np.arange(_ZEROS - 1)] = 1.0
        angles[rest] = np.angle(np.linalg.eigvals(companion))
    start = np.sort(angles, axis=-1)
    end = np.hstack([start[:, 1:], start[:, :1] + 2.0 * np.pi])
    middle = 0.5 * (start + end)
    thickness = 1.0 - eps[:, np.newaxis] * np.cos(middle)
    w = v[:, np.newaxis] + thickness**2 * a[:, np.newaxis]
    positive = (w.conj() * np.exp(1j * middle)).real > 0.0
    first = np.argsort(~positive, axis=-1, kind="stable")  # arcs of positive pressure first
    ends = np.stack([np.take_along_axis(one, first, axis=-1) for one in (start, end)], axis=-1)
    return ends, np.count_nonzero(positive, axis=-1)
