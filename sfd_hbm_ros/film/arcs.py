"""The arcs on which the pressure of a short film is positive.

In the frame of the line of centres the pressure has the sign of

    g(theta) = Re(conj(W) exp(i theta)),   W(theta) = v + (1 - eps cos(theta))^2 a,

with the velocity v and the acceleration a scaled to the same unit (Eq. 13). Without fluid inertia
W is constant and the arc is the half circle about v. With it g is a trigonometric polynomial of
degree 3: it has two zeros as long as the direction of W turns slower than theta, and up to six
otherwise.
"""

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.kernels import kernel, part

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: Most arcs that a state can have (neighbouring arcs may touch).
MOST_ARCS = 6

_TURN_LIMIT = 0.95  # of the rate of theta: below 1 there are two zeros, nearer 1 Newton is slow
_VANISHING = 1e-12  # of |v|^2: a W below it may be a rounded zero, where it turns at once
_ITERATIONS = 8
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


@part
def _several_arcs(eps: float, v: complex, a: complex, ends: Array) -> int:
    """Every interval between neighbouring zeros on which the pressure is positive.

    The zeros are the angles of all six roots of the polynomial in exp(i theta). Roots off the
    unit circle only divide an interval, so that no root has to be judged real or not.
    """
    c3 = eps**2 / 8.0 * a.conjugate()
    if c3 == 0.0:  # a journal at the centre whose velocity and acceleration cancel
        return 0
    c2 = -0.5 * eps * a.conjugate()
    c1 = 0.5 * (v.conjugate() + (1.0 + 0.5 * eps**2) * a.conjugate() + 0.25 * eps**2 * a)
    c0 = complex(-eps * a.real, 0.0)
    lower = (c2, c1, c0, c1.conjugate(), c2.conjugate(), c3.conjugate())
    companion = np.zeros((MOST_ARCS, MOST_ARCS), dtype=np.complex128)
    for i in range(MOST_ARCS):
        companion[0, i] = -lower[i] / c3
        if i > 0:
            companion[i, i - 1] = 1.0
    zeros = np.sort(np.angle(np.linalg.eigvals(companion)))
    count = 0
    for i in range(MOST_ARCS):
        start = zeros[i]
        end = zeros[i + 1] if i + 1 < MOST_ARCS else zeros[0] + 2.0 * math.pi
        middle = 0.5 * (start + end)
        w = v + _thickness_squared(eps, math.cos(middle)) * a
        if (w.conjugate() * cmath.exp(1j * middle)).real > 0.0:
            ends[count, 0], ends[count, 1] = start, end
            count += 1
    return count


@kernel("int64[::1](float64[::1], complex128[::1], complex128[::1], float64[:, :, ::1])")
def positive_arcs(eps: Array, v: ComplexArray, a: ComplexArray, ends: Array) -> NDArray[np.int64]:
    """Arcs of positive pressure of n states.

    Parameters
    ----------
    eps : (n,) array
        Eccentricity.
    v, a : (n,) complex arrays
        Velocity and scaled acceleration a rho c^2/(12 mu), both [m/s], in the frame of the
        line of centres, as x + i y.
    ends : (n, MOST_ARCS, 2) array
        Gets start and end of each state's arcs, as angles from the line of centres [rad].

    Returns
    -------
    (n,) integer array
        Number of each state's arcs, which may be none.
    """
    counts = np.ones(len(eps), dtype=np.int64)
    for i in range(len(eps)):
        single, ends[i, 0, 0], ends[i, 0, 1] = _single_arc(eps[i], v[i], a[i])
        if not single:
            counts[i] = _several_arcs(eps[i], v[i], a[i], ends[i])
    return counts
