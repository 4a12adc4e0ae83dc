"""The shaft's receptance at its ports through Ritz vectors, for many speeds W at one harmonic k.

At the frequency k W the undamped shaft has P11 = K - W^2 B with B = k^2 M - i k G, both Hermitian,
and K positive definite where the journals are held by their ball bearings. Its Ritz vectors give

    H = N^T inv(P11) [N, f] = h^H diag(1 / (1 - W^2 m)) h

at every speed up to a highest one; see `sfd_hbm_ros.rotor.ritz`. It is smooth where elimination
would round differently at every speed. What damps a bearing, or makes its stiffness skew, is added
at the coordinates where it acts, which become ports for it: with its matrix D there,

    H_D = inv(1 + Hn D) H.
"""

from __future__ import annotations

import numpy as np

from sfd_hbm_ros.kernels import kernel
from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray
from sfd_hbm_ros.rotor.banded import adjoint, within
from sfd_hbm_ros.rotor.partition import Partition
from sfd_hbm_ros.rotor.shaft_ritz import shaft_ritz

_NEAREST = 1e-3  # least |1 - W^2 m| at which a damped shaft is found from the undamped one


@kernel(
    "Tuple((complex128[:, :, :, :, ::1], boolean))"
    "(float64, float64, float64[:, :, ::1], complex128[:, :, :, ::1])"
)
def _receptance(
    speed: float, nearest: float, values: RealArray, loads: ComplexArray
) -> tuple[ComplexArray, bool]:
    """H and its derivative by the speed, and whether a harmonic is as near to a mode as that.

    The Ritz values are (s, m, r), the loads (s, m, r, p + 2).
    """
    systems, m, modes, columns = loads.shape
    p = columns - 2
    receptance = np.zeros((2, m, systems, p, columns), dtype=np.complex128)
    for k in range(m):
        for s in range(systems):
            for mode in range(modes):
                gap = 1.0 - speed * speed * values[s, k, mode]
                if abs(gap) <= nearest:
                    return receptance, True
                rate = 2.0 * speed * values[s, k, mode] / gap
                for i in range(p):
                    left = loads[s, k, mode, i].conjugate() / gap
                    for j in range(columns):
                        part = left * loads[s, k, mode, j]
                        receptance[0, k, s, i, j] += part
                        receptance[1, k, s, i, j] += rate * part
    return receptance, False


class ShaftModes:
    """Ritz vectors of the shaft with the journals held, for each of m harmonics of s systems.

    Parameters
    ----------
    parts : Partition
        The rotor.
    orders : (m,) array
        The harmonics.
    highest : float
        Highest speed at which they are wanted [rad/s].

    Raises
    ------
    numpy.linalg.LinAlgError
        If the shaft is not held by its bearings, the journals being held.
    """

    def __init__(self, parts: Partition, orders: RealArray, highest: float) -> None:
        self.highest = highest
        added = _added(parts.shaft)
        places = self._places = np.union1d(parts.ports, np.nonzero(added.any(axis=(0, 1, 3)))[0])
        self._ports = np.searchsorted(places, parts.ports)
        self._added, self._is_added = within(added, places), bool(added.any())
        found = [
            shaft_ritz(terms, force, places, orders, highest)
            for terms, force in zip(parts.shaft, parts.shaft_force, strict=True)
        ]
        most = max(len(one.values) for system in found for one in system)
        self._values = np.zeros((len(found), len(orders), most))
        self._loads = np.zeros((*self._values.shape, len(places) + 2), dtype=complex)
        for s, k in np.ndindex(self._values.shape[:2]):
            values, loads = found[s][k]
            self._values[s, k, : len(values)], self._loads[s, k, : len(values)] = values, loads

    def receptance(self, speed: float, factors: RealArray) -> ComplexArray | None:
        """Return the shaft's receptance and its derivative by the speed.

        Parameters
        ----------
        speed : float
            Rotor speed, at most the highest [rad/s].
        factors : (2, m, 3) array
            Those of `factors.stiffness_factors`.

        Returns
        -------
        H and H' (2, m, s, p, p + 2); None on a mode of the undamped shaft or, where something is
        added to it, near one.
        """
        nearest = _NEAREST if self._is_added else 0.0
        receptance, met = _receptance(speed, nearest, self._values, self._loads)
        if met:
            return None
        return self._with_added(receptance, factors) if self._is_added else receptance

    def _with_added(self, conservative: ComplexArray, factors: RealArray) -> ComplexArray:
        """Return H_D and its derivative."""
        skew, damping = self._added[:, 0], self._added[:, 1]
        w, change = factors[:, :, 0, np.newaxis, np.newaxis, np.newaxis]
        D, D_slope = skew + w * damping, change * damping
        (h, slope), own = conservative, conservative[..., :-2]
        matrix = np.eye(len(self._places)) + own[0] @ D
        h = np.linalg.solve(matrix, h)
        slope = np.linalg.solve(matrix, slope - (own[1] @ D + own[0] @ D_slope) @ h)
        columns = np.append(self._ports, [-2, -1])
        return np.ascontiguousarray(np.stack([h, slope])[..., self._ports[:, np.newaxis], columns])


def _added(shaft: ComplexArray) -> ComplexArray:
    """Return the skew part of K, and i C, (s, 2, n, 2 half + 1)."""
    stiffness = shaft[:, 0]
    return np.stack([0.5 * (stiffness - adjoint(stiffness)), shaft[:, 1]], axis=1)
