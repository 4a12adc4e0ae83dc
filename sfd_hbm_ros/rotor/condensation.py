"""Condensation of the rotor to its dampers' journals, Eqs. 6 to 11 of the paper.

Each harmonic of the speed is q(t) = Re(Q exp(+i w t)), that is Q = Xc - i Xs. The paper writes the
conjugate, R = Xc + j Xs, and so has -j w C in its Eq. 8 where +i w C stands here.

The shaft's part P11 of the dynamic stiffness is banded and is eliminated exactly, all harmonics
and their derivatives by the speed in one call; or, along a branch, through the modes of the
undamped shaft. Where the shaft resonates with its journals held,
and has no damping, the condensed stiffness has a pole. Rounding moves the pole a little: at a
relative distance d from it the stiffness has a relative error of about 1e-12/d for the paper's
rotor, as measured against rational arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sfd_hbm_ros.rotor.arrays import ComplexArray, NumberArray, RealArray
from sfd_hbm_ros.rotor.elimination import condense
from sfd_hbm_ros.rotor.errors import ResonanceError
from sfd_hbm_ros.rotor.frames import Cartesian, Frame, Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.modal_condensation import KeptModes, ShaftModes
from sfd_hbm_ros.rotor.model import RotorModel, force_factor_slopes, force_factors
from sfd_hbm_ros.rotor.pencil import (
    BandedPencil,
    Pencil,
    SingularSystemError,
    bands,
    half_bandwidth,
)


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
    stiffness_slope : (m, n, n) complex array
        Derivative of `stiffness` by the speed [N s/m].
    force_slope : (m, n) complex array
        Derivative of `force` by the speed [N s].
    """

    speed: float
    orders: RealArray
    stiffness: ComplexArray
    force: ComplexArray
    stiffness_slope: ComplexArray
    force_slope: ComplexArray
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
        by_system = terms.swapaxes(0, 1)
        p11, p12 = by_system[..., :n, :n], by_system[..., :n, n:]
        half = half_bandwidth(p11)
        none = np.zeros_like(model.static_force)
        forces = frame.split(np.stack([none, model.static_force, model.unbalance]))
        forces_by_system = forces[1:].swapaxes(0, 1)
        self._parts: tuple[Any, ...] = tuple(
            array.astype(complex, order="C")
            for array in (
                bands(p11, half)[..., half:],
                p12.swapaxes(2, 3),
                by_system[..., n:, :n],
                by_system[..., n:, n:],
                forces_by_system[..., :n],
                forces_by_system[..., n:],
            )
        )
        self._p11, self._p12 = BandedPencil(terms[..., :n, :n]), Pencil(terms[..., :n, n:])
        self._p22 = Pencil(terms[..., n:, n:])
        self._f1, self._f2 = (
            Pencil(forces[..., :n, np.newaxis]),
            np.moveaxis(forces[1:, :, n:], 0, -1),
        )
        self._frame = frame
        self._modes = KeptModes(terms, forces[1:], n)

    def at(self, speed: float, orders: ArrayLike) -> Condensed:
        """Condense the rotor at a speed.

        Parameters
        ----------
        speed : float
            Rotor speed [rad/s].
        orders : (m,) array
            Harmonics, as multiples of the speed, which may be negative.

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
        change = _coefficient_slopes(speed, orders), force_factor_slopes(speed, orders)
        stiffness, force = self._condensed(speed, orders, *change, self._modes.of(orders))
        return Condensed(speed, orders, stiffness[0], force[0], stiffness[1], force[1], self)

    def slope(self, speed: float, orders: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
        """Return the derivatives by the speed of `Condensed.stiffness` and `Condensed.force`.

        Parameters and errors are those of `at`; units [N s/m] and [N s].
        """
        condensed = self.at(speed, orders)
        return condensed.stiffness_slope, condensed.force_slope

    def slope_by_order(self, speed: float, orders: ArrayLike) -> ComplexArray:
        """Return the derivatives of `Condensed.stiffness` by each harmonic's order [N/m].

        Parameters and errors are those of `at`.
        """
        orders = np.asarray(orders, dtype=float)
        w = orders * speed
        change = speed * np.array([np.ones_like(w), np.full_like(w, speed), -2.0 * w]).T
        [_, slope], _ = self._condensed(speed, orders, change, np.zeros((len(orders), 2)))
        return np.asarray(slope)

    def _condensed(
        self,
        speed: float,
        orders: RealArray,
        change: RealArray,
        factor_slopes: RealArray,
        modes: ShaftModes | None = None,
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return stiffness (2, m, n, n) and force (2, m, n), and their derivatives.

        The derivatives are those by whatever changes the coefficients and the force's factors so;
        those through the shaft's modes are by the speed.
        """
        coefficients = np.array([_coefficients(speed, orders), change], order="C")
        factors = np.array([force_factors(speed, orders), factor_slopes], order="C")
        if modes is None:
            arguments = *self._parts, coefficients, factors
            stiffness, force, singular = condense(*arguments)
        else:
            stiffness, force, singular = modes.condense(speed, coefficients, factors)
        if singular >= 0:
            raise ResonanceError(float(orders[singular]), speed)
        return self._frame.join_matrices(stiffness), self._frame.join(force)

    def shaft_response(
        self, speed: float, orders: RealArray, journals: ComplexArray
    ) -> ComplexArray:
        """Return the shaft's amplitudes (m, N - n), R1 of Eq. 7; see `Condensed.recover`."""
        c = _coefficients(speed, orders)
        f1 = self._f1.combine(force_factors(speed, orders))
        force = f1 - self._p12.combine(c) @ self._frame.split(journals)[..., np.newaxis]
        try:
            response = self._p11.solve(c, force)
        except SingularSystemError as error:
            raise ResonanceError(float(orders[error.index]), speed) from error
        return self._frame.join(response[..., 0])


def _coefficients(speed: float, orders: RealArray) -> RealArray:
    """Return the factors of i C, i G and M beside K in the dynamic stiffness, Eq. 8."""
    w = orders * speed
    return np.array([w, w * speed, -(w**2)]).T


def _coefficient_slopes(speed: float, orders: RealArray) -> RealArray:
    """Return the derivatives of `_coefficients` by the speed."""
    return np.array([orders, 2.0 * orders * speed, -2.0 * orders**2 * speed]).T
