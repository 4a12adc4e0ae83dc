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

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film.arcs import Arcs

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SMALL = 0.35  # below this beta the logarithm's tail cancels and is integrated instead
_nodes, _weights = np.polynomial.legendre.leggauss(9)
_NODES = 0.5 * (_nodes + 1.0)
_TAIL_WEIGHTS = 0.5 * _weights * _NODES**2


class ArcIntegrals:
    """J(p, m) of n states, each summed over the state's arcs.

    Parameters
    ----------
    eccentricity : (n,) array
        Eccentricities eps, 0 <= eps < 1.
    arcs : Arcs
        The arcs of each state.
    """

    def __init__(self, eccentricity: Array, arcs: Arcs) -> None:
        self._eps = eps = eccentricity
        self._s = np.sqrt((1.0 - eps) * (1.0 + eps))
        self._beta = eps / (1.0 + self._s)
        beta = self._beta[arcs.state]
        w = np.cos(arcs.ends) + 1j * np.sin(arcs.ends)
        u = beta * w
        l3 = _log_tail(u, beta)
        l2 = 0.5 + u * l3
        l1 = 1.0 + u * l2
        log = u * l1  # -log(1 - u)
        pole = 1.0 / (1.0 - u)
        zeta = (w - beta) * pole  # exp(i gamma)
        w2, zeta2 = w * w, zeta * zeta
        # every antiderivative is a combination of these, with factors that depend on eps alone
        functions = np.stack(
            [
                arcs.ends + 0j,
                arcs.ends + 2.0 * log.imag + 0j,  # gamma
                zeta / 1j,
                zeta2 / 2j,
                zeta * zeta2 / 3j,
                log.conj(),
                w * l1,
                w2 * l2,
                w * w2 * l3,
                pole,
                w * pole,
                w * w2 * pole,
                w,
                w2,
            ]
        )
        over_arcs = functions[:, 1] - functions[:, 0]
        if len(arcs.state) != len(eps) or np.any(arcs.state[1:] <= arcs.state[:-1]):
            of_arcs, over_arcs = over_arcs, np.zeros((len(functions), len(eps)), dtype=complex)
            for total, part in zip(over_arcs, of_arcs, strict=True):
                np.add.at(total, arcs.state, part)
        self._theta, self._gamma = over_arcs[0].real, over_arcs[1].real
        self._zeta = over_arcs[2:5]
        self._log_conj, self._wl1, self._w2l2, self._w3l3 = over_arcs[5:9]
        self._pole, self._w_pole, self._w3_pole, self._w, self._w2 = over_arcs[9:]

    def of_force(self) -> tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray]:
        """J(3, 0), J(3, 2), J(1, 0) and J(1, 2), each (n,)."""
        eps, s, beta2 = self._eps, self._s, self._beta**2
        a, b, s5 = 0.5 * (1.0 + s), 0.5 * (1.0 - s), s**-5
        half, quarter = 0.5 * eps**2, 0.25 * eps**2
        j30 = s5 * self._polynomial(quarter, eps, 1.0 + half, eps, quarter)
        j32 = s5 * self._polynomial(b * b, 2 * eps * b, 3 * half, 2 * eps * a, a * a)
        j12 = beta2 * self._theta - 1j * (
            self._beta * self._w + self._w2l2 - beta2 * self._log_conj
        )
        return j30, j32, self._gamma / s + 0j, j12 / s

    def of_gradient(self) -> tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray]:
        """J(4, 1), J(4, 3), J(2, 1) and J(2, 3), each (n,)."""
        eps, s, beta = self._eps, self._s, self._beta
        a, b, q = 0.5 * (1.0 + s), 0.5 * (1.0 - s), 0.25 * eps**2
        s3, s7 = s**-3, s**-7
        inner, outer = 1.0 + 2.0 * q, eps * q
        j41 = self._polynomial(
            b * q,
            outer + b * eps,
            4.0 * q + b * inner + a * q,
            eps * (2.0 + 2.0 * q),
            4.0 * q + a * inner + b * q,
            outer + a * eps,
            a * q,
        )
        j43 = self._polynomial(
            b**3, 3 * b * b * eps, 15 * b * q, 10 * q * eps, 15 * a * q, 3 * a * a * eps, a**3
        )
        pole_conj = self._pole.conj()
        j21 = eps * self._theta - 1j * (
            (1.0 - s) * self._wl1
            + s * self._w_pole
            - beta * ((1.0 + s) * self._log_conj + s * pole_conj)
        )
        j23 = (1.0 + 3.0 * s) * beta**3 * self._theta - 1j * (
            (1.0 + 2.0 * s) * beta**2 * self._w
            + 0.5 * (1.0 + s) * beta * self._w2
            + (1.0 - 3.0 * s) * self._w3l3
            + s * self._w3_pole
            - beta**3 * ((1.0 + 3.0 * s) * self._log_conj + s * pole_conj)
        )
        return s7 * j41, s7 * j43, s3 * j21, s3 * j23

    def _polynomial(self, *c: Array) -> ComplexArray:
        """Integral over gamma of sum c[m] exp(i m gamma), m = -k..k."""
        k = len(c) // 2
        total: ComplexArray = c[k] * self._gamma + 0j
        for m in range(1, k + 1):
            power = self._zeta[m - 1]
            total += c[k + m] * power + c[k - m] * power.conj()
        return total


def _log_tail(u: ComplexArray, beta: Array) -> ComplexArray:
    """(-log(1 - u) - u - u^2/2)/u^3, the sum of u^n/(n + 3), for |u| = beta."""
    small = beta < _SMALL
    safe = np.where(small, 0.5, u)
    gap = 1.0 - safe
    log = 0.5 * np.log(gap.real**2 + gap.imag**2) + 1j * np.arctan2(gap.imag, gap.real)
    inverse = 1.0 / safe
    tail: ComplexArray = ((-log * inverse - 1.0) * inverse - 0.5) * inverse
    if small.any():
        tail[:, small] = (1.0 / (1.0 - u[:, small, None] * _NODES)) @ _TAIL_WEIGHTS
    return tail
