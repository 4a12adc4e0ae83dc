"""The rotor as matrices and forces, Eq. 1 of the paper: M q'' + (C + W G) q' + K q = f(t)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, RealArray, SparseArray
from sfd_hbm_ros.rotor.factors import force_factors


class Matrices(NamedTuple):
    """The rotor's matrices (N, N), sparse: every element couples two neighbours alone."""

    M: SparseArray
    C: SparseArray
    G: SparseArray
    K: SparseArray


@dataclass(frozen=True, eq=False)
class RotorModel:
    """Matrices and linear forces of a rotor with N coordinates, its dampers' films left out.

    The coordinates are (x, y, x', y') of every shaft node in turn, then (x, y) of every damper's
    journal; see `sfd_hbm_ros.rotor.assembly`.

    Parameters
    ----------
    matrices : Matrices
        Mass, damping, gyroscopic matrix for unit speed, and stiffness, in SI units.
    journals : (dampers, 2) array of int
        Coordinates (x, y) of each damper's journal, in the machine's order.
    stations : mapping of str to (2,) array of int
        Coordinates (x, y) of the shaft at each station.
    unbalance : (N,) complex array
        Amplitude of the unbalance's force over the speed squared [kg m].
    static_force : (N,) array
        Loads, and the weight if the machine has it [N].
    """

    matrices: Matrices
    journals: IndexArray
    stations: Mapping[str, IndexArray]
    unbalance: ComplexArray
    static_force: RealArray

    @cached_property
    def M(self) -> RealArray:
        """Mass as a full array, (N, N), as are C, G and K: for rotors of few coordinates."""
        return _full(self.matrices.M)

    @cached_property
    def C(self) -> RealArray:
        """Damping, (N, N)."""
        return _full(self.matrices.C)

    @cached_property
    def G(self) -> RealArray:
        """Gyroscopic matrix for unit speed, (N, N)."""
        return _full(self.matrices.G)

    @cached_property
    def K(self) -> RealArray:
        """Stiffness, (N, N)."""
        return _full(self.matrices.K)

    @property
    def size(self) -> int:
        """Number N of all coordinates."""
        return len(self.static_force)

    @property
    def shaft_size(self) -> int:
        """Number of the shaft's coordinates, which come before the journals'."""
        return self.size - self.journals.size

    def linear_force(self, speed: float, orders: ArrayLike) -> ComplexArray:
        """Return the amplitudes of all forces but the films', for orders of the speed.

        Parameters
        ----------
        speed : float
            Rotor speed [rad/s].
        orders : (m,) array
            Multiples of the speed. Order 0 has the static force, order 1 the unbalance's.

        Returns
        -------
        (m, N) complex array
            F in f(t) = Re(F exp(i order speed t)) [N, N m].
        """
        forces = np.stack([self.static_force, self.unbalance])
        return np.asarray(force_factors(speed, np.array(orders, dtype=float), 1.0)[0] @ forces)

    def load(self, speed: float, orders: RealArray) -> float:
        """Return the norm of `linear_force` [N]; parameters are those of it."""
        return float(np.linalg.norm(force_factors(speed, orders, 1.0)[0] * self._force_norms))

    @cached_property
    def _force_norms(self) -> RealArray:
        return np.asarray(np.linalg.norm([self.static_force, self.unbalance], axis=1))


def _full(matrix: SparseArray) -> RealArray:
    return np.asarray(matrix.toarray())
