"""The rotor as its journals feel it in the frame that turns with it.

What whirls forward at k w in the turning frame does so at W + k w in the fixed one. What whirls
backward there is, as its conjugate, forward whirl at W - k w.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.rotor import Condensation, Condensed
from sfd_hbm_ros.rotor.frames import Whirl

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class TurningRotor:
    """An axisymmetric rotor, condensed to its n journal coordinates, at one speed.

    Its matrices (rows n, rows n) and forces (rows n,) are over the coefficients of the motion in
    the turning frame.

    Attributes
    ----------
    condensation : Condensation
        The rotor.
    harmonics : Harmonics
        Multiples of a frequency w, all up to the highest.
    speed : float
        Rotor speed W [rad/s].
    """

    condensation: Condensation
    harmonics: Harmonics
    speed: float

    def at(self, w: float) -> tuple[Array, Array]:
        """Dynamic stiffness [N/m] and the unbalance's force [N] at a frequency w [rad/s].

        Raises
        ------
        ResonanceError
            If a whirl W + k w meets an undamped resonance of the shaft with its journals held.
        """
        condensed = self._condensed(w)
        return self._matrix(condensed.stiffness), self._standing(condensed.force)

    def slope_by_frequency(self, w: float) -> Array:
        """Derivative of the stiffness by w [N s/m]; the force does not depend on it."""
        by_order = self._slope_by_order(w)
        return self._matrix(by_order * (self._multiples / self.speed)[:, np.newaxis, np.newaxis])

    def slope_by_speed(self, w: float) -> tuple[Array, Array]:
        """Derivatives of stiffness [N s/m] and force [N s] by the speed at the same w."""
        condensed = self._condensed(w)
        # they are those at the same orders 1 + k w / W, which at the same w change with W
        by_orders = self.slope_by_frequency(w) * (w / self.speed)
        return self._matrix(condensed.stiffness_slope) - by_orders, self._standing(
            condensed.force_slope
        )

    @cached_property
    def _condensed(self) -> Callable[[float], Condensed]:
        """The rotor condensed at a frequency, which is asked for several times."""
        return lru_cache(1)(lambda w: self.condensation.at(self.speed, self._orders(w)))

    @cached_property
    def _slope_by_order(self) -> Callable[[float], ComplexArray]:
        return lru_cache(1)(
            lambda w: self.condensation.slope_by_order(self.speed, self._orders(w))
        )

    @cached_property
    def _multiples(self) -> Array:
        return np.arange(-self.harmonics.highest, self.harmonics.highest + 1.0)

    def _orders(self, w: float) -> Array:
        """The frequencies W + k w as multiples of W, (2K + 1,)."""
        return 1.0 + self._multiples * (w / self.speed)

    def _matrix(self, stiffness: ComplexArray) -> Array:
        """Real matrix over the coefficients of the stiffness at each W + k w."""
        forward = stiffness[:, ::2, ::2] - 1j * stiffness[:, ::2, 1::2]
        k, size = self.harmonics.highest, self.harmonics.rows * stiffness.shape[1]
        both = np.stack([forward[k:], forward[k::-1].conj()], axis=1)
        return self.harmonics.real_matrix(Whirl().join_matrices(both)).reshape(size, size)

    def _standing(self, force: ComplexArray) -> Array:
        """Coefficients of the force at W, which stands still in the turning frame."""
        rows = np.zeros((self.harmonics.rows, force.shape[1]))
        rows[0] = force[self.harmonics.highest].real
        return rows.ravel()
