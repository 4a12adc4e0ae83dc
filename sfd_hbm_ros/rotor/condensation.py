"""Condensation of the rotor to its dampers' journals, Eqs. 6 to 11 of the paper.

Each harmonic of the speed is q(t) = Re(Q exp(+i w t)), that is Q = Xc - i Xs. The paper writes the
conjugate, R = Xc + j Xs, and so has -j w C in its Eq. 8 where +i w C stands here.

The shaft's part P11 of the dynamic stiffness is banded and is eliminated exactly, at a cost that
grows with the number of coordinates; or, where the same harmonics are asked for again and again,
as along a branch, Ritz vectors stand for it, as many for a coarse mesh as for a fine one. Where
the shaft resonates with its journals held, and has no damping, the condensed stiffness has a pole.
Rounding moves the pole a little: at a relative distance d from it the stiffness has a relative
error of about 1e-12/d for the paper's rotor, as measured against rational arithmetic.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from sfd_hbm_ros.rotor import banded
from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray
from sfd_hbm_ros.rotor.condensed import Condensed
from sfd_hbm_ros.rotor.coupling import couple
from sfd_hbm_ros.rotor.elimination import eliminate
from sfd_hbm_ros.rotor.errors import ResonanceError
from sfd_hbm_ros.rotor.factors import force_factors, stiffness_factors
from sfd_hbm_ros.rotor.kept_modes import KeptModes
from sfd_hbm_ros.rotor.model import RotorModel
from sfd_hbm_ros.rotor.partition import partition


class Condensation:
    """Condenses one rotor, at any speed and for any harmonics.

    Parameters
    ----------
    model : RotorModel
        The rotor. If it is axisymmetric, its forward and backward whirl are solved apart.
    """

    def __init__(self, model: RotorModel) -> None:
        self._parts = partition(model)
        self._modes = KeptModes(self._parts)

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
        orders = np.array(orders, dtype=float)
        factors = stiffness_factors(speed, orders, 1.0, 0.0)
        receptance = self._modes.receptance(speed, orders, factors)
        if receptance is None:
            receptance = self._eliminated(speed, orders, factors)
        forces = force_factors(speed, orders, 1.0)
        stiffness, force = self._coupled(receptance, factors, forces)
        arrays = stiffness[0], force[0], stiffness[1], force[1]
        return Condensed(speed, orders, *arrays, self.shaft_response)

    def slope_by_order(self, speed: float, orders: ArrayLike) -> ComplexArray:
        """Return the derivatives of `Condensed.stiffness` by each harmonic's order [N/m].

        Parameters and errors are those of `at`.
        """
        orders = np.array(orders, dtype=float)
        factors = stiffness_factors(speed, orders, 0.0, 1.0)
        receptance = self._eliminated(speed, orders, factors)
        [_, slope], _ = self._coupled(receptance, factors, force_factors(speed, orders, 0.0))
        return np.asarray(slope)

    def _eliminated(self, speed: float, orders: RealArray, factors: RealArray) -> ComplexArray:
        """Return the shaft's receptance, exactly."""
        parts = self._parts
        try:
            return eliminate(parts.shaft, parts.ports, parts.shaft_force, factors)
        except banded.SingularSystemError as error:
            raise self._resonance(error, speed, orders) from error

    def _coupled(
        self, receptance: ComplexArray, factors: RealArray, forces: RealArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return stiffness (2, m, n, n) and force (2, m, n), and their derivatives."""
        parts = self._parts
        ties = parts.z12, parts.z21, parts.z22, parts.journal_force
        stiffness, force = couple(receptance, factors, forces, *ties)
        return parts.frame.join_matrices(stiffness), parts.frame.join(force)

    def shaft_response(
        self, speed: float, orders: RealArray, journals: ComplexArray
    ) -> ComplexArray:
        """Return the shaft's amplitudes (m, N - n), R1 of Eq. 7; see `Condensed.recover`."""
        parts = self._parts
        factors = np.insert(stiffness_factors(speed, orders, 1.0, 0.0)[0], 0, 1.0, axis=1)
        ties = np.tensordot(factors, parts.z12, (1, 1))
        force = np.einsum("mf,sfn->msn", force_factors(speed, orders, 1.0)[0], parts.shaft_force)
        force[..., parts.ports] -= (ties @ parts.frame.split(journals)[..., np.newaxis])[..., 0]
        shaft = np.tensordot(factors, parts.shaft, (1, 1))
        try:
            response = banded.Factorised(shaft).solve(force[..., np.newaxis])
        except banded.SingularSystemError as error:
            raise self._resonance(error, speed, orders) from error
        return parts.frame.join(response[..., 0])

    def _resonance(
        self, error: banded.SingularSystemError, speed: float, orders: RealArray
    ) -> ResonanceError:
        """Return which harmonic meets a resonance."""
        systems = len(self._parts.shaft)
        return ResonanceError(float(orders[error.index // systems]), speed)
