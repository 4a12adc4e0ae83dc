"""The rotor as its dampers' journals feel it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray


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
    _shaft_response: Callable[[float, RealArray, ComplexArray], ComplexArray] = field(repr=False)

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
        shaft = self._shaft_response(self.speed, self.orders, journals)
        return np.concatenate([shaft, journals], axis=1)
