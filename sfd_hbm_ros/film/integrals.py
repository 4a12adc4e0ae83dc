r"""Closed-form integrals of the short film over arcs of its circumference.

With the angle theta measured from the line of centres and the dimensionless film thickness
eta = 1 - eps cos(theta), every force and derivative of a short film is a combination of

    J(p, m) = \int exp(i m theta) / eta^p  dtheta,

    (p, m) = (3, 0), (3, 2), (1, 0), (1, 2)      for the force (viscous; inertial)
             (4, 1), (4, 3), (2, 1), (2, 3)      for its derivative by the position.

For p = 3, 4 Sommerfeld's angle gamma, eta = (1 - eps^2)/(1 + eps cos(gamma)), turns the
integrand into a trigonometric polynomial (Booker 1965, J. Basic Eng. 87, 168). For p = 1, 2 the
Fourier series of 1/eta^p, geometric in beta = eps/(1 + sqrt(1 - eps^2)), sums to logarithms.
Both forms hold for every 0 <= eps < 1 without a division by eps.
"""

import math

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.kernels import kernel, part

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SMALL = 0.35  # below this beta the logarithm's tail cancels and is integrated instead
_nodes, _weights = np.polynomial.legendre.leggauss(9)
_NODES = 0.5 * (_nodes + 1.0)
_WEIGHTS = 0.5 * _weights
_TAIL_WEIGHTS = _WEIGHTS * _NODES**2
_SHORT = 0.5  # half-length [rad] up to which the nodes resolve exp(3i theta) to rounding
_FAR = 4.0  # half-lengths from the pole of 1/eta at which the nodes resolve an arc to rounding
_FUNCTIONS = 14


@part
def _functions(values: ComplexArray, theta: float, beta: float) -> None:
    """Set the functions of which every antiderivative is a combination, at one end of an arc.

    The factors of the combination depend on eps alone.
    """
    w = complex(math.cos(theta), math.sin(theta))
    u = beta * w
    l3 = _log_tail(u, beta)
    l2 = 0.5 + u * l3
    l1 = 1.0 + u * l2
    log = u * l1  # -log(1 - u)
    pole = _inverse(1.0 - u)
    zeta = (w - beta) * pole  # exp(i gamma)
    w2, zeta2 = w * w, zeta * zeta
    values[0] = theta
    values[1] = theta + 2.0 * log.imag  # gamma
    values[2] = -1j * zeta
    values[3] = -0.5j * zeta2
    values[4] = -1j / 3.0 * (zeta * zeta2)
    values[5] = log.conjugate()
    values[6] = w * l1
    values[7] = w2 * l2
    values[8] = w * w2 * l3
    values[9] = pole
    values[10] = w * pole
    values[11] = w * w2 * pole
    values[12] = w
    values[13] = w2


@part
def _log_tail(u: complex, beta: float) -> complex:
    """(-log(1 - u) - u - u^2/2)/u^3, the sum of u^n/(n + 3), for |u| = beta."""
    if beta >= _SMALL:
        inverse, gap = _inverse(u), 1.0 - u
        square = gap.real * gap.real + gap.imag * gap.imag
        log = complex(0.5 * math.log(square), math.atan2(gap.imag, gap.real))
        return ((-log * inverse - 1.0) * inverse - 0.5) * inverse
    tail = 0.0j
    for k in range(len(_NODES)):
        tail += _TAIL_WEIGHTS[k] * _inverse(1.0 - _NODES[k] * u)
    return tail


@part
def _inverse(z: complex) -> complex:
    """1/z by one real division, where neither overflow nor underflow can happen."""
    scale = 1.0 / (z.real * z.real + z.imag * z.imag)
    return complex(z.real * scale, -z.imag * scale)


@part
def _add_force(j: ComplexArray, total: ComplexArray, eps: float, s: float, beta: float) -> None:
    """J(3, 0), J(3, 2), J(1, 0) and J(1, 2)."""
    theta, gamma, log_conj = total[0].real, total[1].real, total[5]
    a, b, s5, beta2 = 0.5 * (1.0 + s), 0.5 * (1.0 - s), s**5, beta * beta
    half, quarter = 0.5 * eps**2, 0.25 * eps**2
    j[0] += _polynomial(total, (1.0 + half, eps, quarter), (eps, quarter)) / s5
    j[1] += _polynomial(total, (3.0 * half, 2.0 * eps * a, a * a), (2.0 * eps * b, b * b)) / s5
    j[2] += gamma / s
    j[3] += (beta2 * theta - 1j * (beta * total[12] + total[7] - beta2 * log_conj)) / s


@part
def _add_gradient(j: ComplexArray, total: ComplexArray, eps: float, s: float, beta: float) -> None:
    """J(4, 1), J(4, 3), J(2, 1) and J(2, 3)."""
    theta, log_conj, pole_conj = total[0].real, total[5], total[9].conjugate()
    a, b, q = 0.5 * (1.0 + s), 0.5 * (1.0 - s), 0.25 * eps**2
    inner, outer = 1.0 + 2.0 * q, eps * q
    s3, s7 = s**3, s**7
    j[4] += (
        _polynomial(
            total,
            (eps * (2.0 + 2.0 * q), 4.0 * q + a * inner + b * q, outer + a * eps, a * q),
            (4.0 * q + b * inner + a * q, outer + b * eps, b * q),
        )
        / s7
    )
    j[5] += (
        _polynomial(
            total,
            (10.0 * q * eps, 15.0 * a * q, 3.0 * a * a * eps, a**3),
            (15.0 * b * q, 3.0 * b * b * eps, b**3),
        )
        / s7
    )
    j21 = (1.0 - s) * total[6] + s * total[10]
    j21 -= beta * ((1.0 + s) * log_conj + s * pole_conj)
    j23 = (1.0 + 2.0 * s) * beta**2 * total[12] + 0.5 * (1.0 + s) * beta * total[13]
    j23 += (1.0 - 3.0 * s) * total[8] + s * total[11]
    j23 -= beta**3 * ((1.0 + 3.0 * s) * log_conj + s * pole_conj)
    j[6] += (eps * theta - 1j * j21) / s3
    j[7] += ((1.0 + 3.0 * s) * beta**3 * theta - 1j * j23) / s3


@part
def _polynomial(
    total: ComplexArray, ahead: tuple[float, ...], behind: tuple[float, ...]
) -> complex:
    """Integral over gamma of sum c[m] exp(i m gamma), c[0], c[1], ... and c[-1], c[-2], ..."""
    value: complex = ahead[0] * total[1]
    for m in range(len(behind)):
        power = total[2 + m]
        value += ahead[m + 1] * power + behind[m] * power.conjugate()
    return value


@part
def _is_short(start: float, end: float, beta: float) -> bool:
    """Whether an arc is short beside its distance from the pole, which is at i log(beta).

    Its integrals are then small differences of large antiderivatives.
    """
    half = 0.5 * (end - start)
    if half > _SHORT or beta == 0.0:
        return False
    middle = 0.5 * (start + end)
    middle -= 2.0 * math.pi * math.floor(middle / (2.0 * math.pi) + 0.5)
    return math.hypot(middle, math.log(beta)) > _FAR * half


@part
def _add_short(j: ComplexArray, start: float, end: float, eps: float) -> None:
    """Add all J(p, m) of a short arc, by Gauss-Legendre quadrature."""
    for k in range(len(_NODES)):
        theta = start + (end - start) * _NODES[k]
        e = complex(math.cos(theta), math.sin(theta))
        first = 1.0 / (1.0 - eps * e.real)
        weight = (end - start) * _WEIGHTS[k] * first
        e2, third = e * e, weight * first * first
        j[0] += third
        j[1] += third * e2
        j[2] += weight
        j[3] += weight * e2
        j[4] += third * first * e
        j[5] += third * first * e2 * e
        j[6] += weight * first * e
        j[7] += weight * first * e2 * e


@kernel("complex128[:, ::1](float64[::1], float64[:, :, ::1], int64[::1])")
def arc_integrals(eccentricity: Array, ends: Array, counts: NDArray[np.int64]) -> ComplexArray:
    """J(p, m) of n states, each summed over the state's arcs.

    Parameters
    ----------
    eccentricity : (n,) array
        Eccentricities eps, 0 <= eps < 1.
    ends : (n, arcs, 2) array
        Start and end of each state's arcs, as angles from the line of centres [rad].
    counts : (n,) integer array
        Number of each state's arcs.

    Returns
    -------
    (n, 8) complex array
        J(3, 0), J(3, 2), J(1, 0), J(1, 2), J(4, 1), J(4, 3), J(2, 1), J(2, 3).
    """
    result = np.empty((len(eccentricity), 8), dtype=np.complex128)
    start = np.empty(_FUNCTIONS, dtype=np.complex128)
    end, total = np.empty_like(start), np.empty_like(start)
    for i in range(len(eccentricity)):
        eps = eccentricity[i]
        s = math.sqrt((1.0 - eps) * (1.0 + eps))
        beta = eps / (1.0 + s)
        total[:] = 0.0
        closed = False
        result[i] = 0.0
        for arc in range(counts[i]):
            if _is_short(ends[i, arc, 0], ends[i, arc, 1], beta):
                _add_short(result[i], ends[i, arc, 0], ends[i, arc, 1], eps)
                continue
            _functions(start, ends[i, arc, 0], beta)
            _functions(end, ends[i, arc, 1], beta)
            for k in range(_FUNCTIONS):
                total[k] += end[k] - start[k]
            closed = True
        if closed:
            _add_force(result[i], total, eps, s, beta)
            _add_gradient(result[i], total, eps, s, beta)
    return result
