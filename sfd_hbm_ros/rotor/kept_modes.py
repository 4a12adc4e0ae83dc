"""The shaft's Ritz vectors, kept while the same harmonics are asked for."""

from __future__ import annotations

import numpy as np

from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray
from sfd_hbm_ros.rotor.partition import Partition
from sfd_hbm_ros.rotor.shaft_modes import ShaftModes

_WORTHWHILE = 20  # uses in a row after which Ritz vectors pay
_RESERVE = 2.0  # of the speed, up to which they serve from then on


class KeptModes:
    """The shaft's modes at the harmonics that are asked for again and again, as along a branch.

    Parameters
    ----------
    parts : Partition
        The rotor.
    """

    def __init__(self, parts: Partition) -> None:
        self._parts = parts
        self._exist = True
        self._kept: dict[bytes, ShaftModes] = {}
        self._latest, self._uses = b"", 0

    def receptance(
        self, speed: float, orders: RealArray, factors: RealArray
    ) -> ComplexArray | None:
        """Return `ShaftModes.receptance`, or None where modes do not exist, pay or serve."""
        modes = self._of(speed, orders)
        return None if modes is None else modes.receptance(speed, factors)

    def _of(self, speed: float, orders: RealArray) -> ShaftModes | None:
        """Return the modes at harmonics (m,), or None where they do not exist or pay."""
        key = orders.tobytes()
        kept = self._kept.get(key)
        if kept is not None and abs(speed) <= kept.highest:
            return kept
        self._uses = self._uses + 1 if key == self._latest else 1
        self._latest = key
        if not self._exist or (kept is None and self._uses < _WORTHWHILE):
            return None
        try:
            modes = self._kept[key] = ShaftModes(self._parts, orders, _RESERVE * abs(speed))
        except np.linalg.LinAlgError:  # the shaft is free to move: K is singular
            self._exist = False
            return None
        return modes
