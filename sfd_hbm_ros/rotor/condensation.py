"""Condensation of the rotor to its dampers' journals, Eqs. 6 to 11 of the paper.

Each harmonic of the speed is q(t) = Re(Q exp(+i w t)), that is Q = Xc - i Xs. The paper writes the
conjugate, R = Xc + j Xs, and so has -j w C in its Eq. 8 where +i w C stands here.

The shaft's part P11 of the dynamic stiffness is banded and is eliminated exactly, all harmonics in
one call. Where the shaft resonates with its journals held, and has no damping, the condensed
stiffness has a pole. Rounding moves the pole a little: at a relative distance d from it the
stiffness has a relative error of about 1e-12/d for the paper's rotor, as measured against rational
arithmetic.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from sfd_hbm_ros.rotor.arrays import ComplexArray, NumberArray, RealArray
from sfd_hbm_ros.rotor.errors import ResonanceError
from sfd_hbm_ros.rotor.frames import Cartesian, Frame, Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.model import RotorModel, force_factor_slopes, force_factors
from sfd_hbm_ros.rotor.pencil import BandedPencil, Pencil, SingularSystemError


@dataclass(frozen=True, eq=False)
class Condensed:
    """The rotor as its n journal coordinates feel it, at one speed, for m harmonics.

    With Q the journals' amplitudes and F the films' forces on the journals, `stiffness` Q =
    `force` + F for each harmonic: Eq. 9, where `stiffness` is U and `force` is -V.

    Parameters
    ----------
    speed : float
        Rotor speed [rad/s].
    orders : (m,) array
        Harmonics, as multiples of the speed.
    stiffness : (m, n, n) complex array
        Dynamic stiffness U of Eq. 10 [N/m].
    force : (m, n) complex array
        Linear force, -V of Eq. 11 [N].
    """

    speed: float
    orders: RealArray
    stiffness: ComplexArray
    force: ComplexArray
    _condensation: Condensation = field(repr=False)

    def recover(self, journals: ArrayLike) -> ComplexArray:
        """Return the response at every coordinate of the rotor, R1 and R2 of Eq. 7.

        Parameters
        ----------
        journals : (m, n) complex array
            Amplitudes of the journals [m].

        Returns
        -------
        (m, N) complex array
            Amplitudes of all coordinates, the journals' among them [m, rad].
        """
        journals = np.asarray(journals, dtype=complex)
        shaft = self._condensation.shaft_response(self.speed, self.orders, journals)
        return np.concatenate([shaft, journals], axis=1)


class Condensation:
    """Condenses one rotor, at any speed and for any harmonics.

    Parameters
    ----------
    model : RotorModel
        The rotor. If it is axisymmetric, its forward and backward whirl are solved apart.
    """

    def __init__(self, model: RotorModel) -> None:
        matrices = model.K, model.C, model.G, model.M
        frame: Frame = Whirl() if is_axisymmetric(model) else Cartesian()
        complex_terms = np.stack([frame.systems(matrix) for matrix in matrices])
        complex_terms[1:3] *= 1j
        # Forward and backward whirl of an undamped shaft are real: half of the work.
        terms: NumberArray = complex_terms if complex_terms.imag.any() else complex_terms.real
        n = terms.shape[-1] * model.shaft_size // model.size
        p11, p21 = terms[..., :n, :n], terms[..., n:, :n]
        self._p11, self._p12 = BandedPencil(p11), Pencil(terms[..., :n, n:])
        self._p11_dense = Pencil(p11)
        self._p11_transposed = BandedPencil(p11.swapaxes(2, 3))
        self._p21_transposed = Pencil(p21.swapaxes(2, 3))
        self._p22 = Pencil(terms[..., n:, n:])
        none = np.zeros_like(model.static_force)
        forces = frame.split(np.stack([none, model.static_force, model.unbalance]))
        self._f1, self._f2 = (
            Pencil(forces[..., :n, np.newaxis]),
            Pencil(forces[..., n:, np.newaxis]),
        )
        self._frame = frame

    def at(self, speed: float, orders: ArrayLike) -> Condensed:
        """Condense the rotor at a speed.

        Parameters
        ----------
        speed : float
            Rotor speed [rad/s].
        orders : (m,) array
            Harmonics, as multiples >= 0 of the speed.

        Returns
        -------
        Condensed
            Stiffness and force for the journals.

        Raises
        ------
        ResonanceError
            If a harmonic meets an undamped resonance of the shaft with its journals held.
        """
        orders = np.asarray(orders, dtype=float)
        c = _coefficients(speed, orders)
        # P21 inv(P11) serves both Eq. 10 and Eq. 11; its transpose is what can be solved for.
        with _naming_resonance(speed, orders):
            transposed = self._p11_transposed.solve(c, self._p21_transposed.combine(c))
        p21_over_p11 = transposed.swapaxes(2, 3)
        stiffness = self._p22.combine(c) - p21_over_p11 @ self._p12.combine(c)
        factors = force_factors(speed, orders)
        force = self._f2.combine(factors) - p21_over_p11 @ self._f1.combine(factors)
        join, join_matrices = self._frame.join, self._frame.join_matrices
        return Condensed(speed, orders, join_matrices(stiffness), join(force[..., 0]), self)

    def slope(self, speed: float, orders: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
        """Return the derivatives by the speed of `Condensed.stiffness` and `Condensed.force`.

        With X = inv(P11) P12, Y = P21 inv(P11) and g = inv(P11) F1, Eqs. 10 and 11 give

            U' = P22' - Y P12' - P21' X + Y P11' X,    -V' = F2' - Y F1' - (P21' - Y P11') g.

        Parameters and errors are those of `at`; units [N s/m] and [N s].
        """
        orders = np.asarray(orders, dtype=float)
        c, change = _coefficients(speed, orders), _coefficient_slopes(speed, orders)
        factors, factor_slopes = force_factors(speed, orders), force_factor_slopes(speed, orders)
        rhs = np.concatenate([self._p12.combine(c), self._f1.combine(factors)], axis=-1)
        with _naming_resonance(speed, orders):
            y = self._p11_transposed.solve(c, self._p21_transposed.combine(c)).swapaxes(2, 3)
            x_and_g = self._p11.solve(c, rhs)
        p21_slope = self._p21_transposed.change(change).swapaxes(2, 3)
        both = (y @ self._p11_dense.change(change) - p21_slope) @ x_and_g
        stiffness = self._p22.change(change) - y @ self._p12.change(change) + both[..., :-1]
        direct = self._f2.change(factor_slopes) - y @ self._f1.change(factor_slopes)
        force = direct + both[..., -1:]
        return self._frame.join_matrices(stiffness), self._frame.join(force[..., 0])

    def shaft_response(
        self, speed: float, orders: RealArray, journals: ComplexArray
    ) -> ComplexArray:
        """Return the shaft's amplitudes (m, N - n), R1 of Eq. 7; see `Condensed.recover`."""
        c = _coefficients(speed, orders)
        f1 = self._f1.combine(force_factors(speed, orders))
        force = f1 - self._p12.combine(c) @ self._frame.split(journals)[..., np.newaxis]
        with _naming_resonance(speed, orders):
            response = self._p11.solve(c, force)
        return self._frame.join(response[..., 0])


def _coefficients(speed: float, orders: RealArray) -> RealArray:
    """Return the factors of i C, i G and M beside K in the dynamic stiffness, Eq. 8."""
    w = orders * speed
    return np.array([w, w * speed, -(w**2)]).T


def _coefficient_slopes(speed: float, orders: RealArray) -> RealArray:
    """Return the derivatives of `_coefficients` by the speed."""
    return np.array([orders, 2.0 * orders * speed, -2.0 * orders**2 * speed]).T


@contextmanager
def _naming_resonance(speed: float, orders: RealArray) -> Iterator[None]:
    """Turn a singular system into the harmonic and speed at which it is singular."""
    try:
        yield
    except SingularSystemError as error:
        raise ResonanceError(float(orders[error.index]), speed) from error
