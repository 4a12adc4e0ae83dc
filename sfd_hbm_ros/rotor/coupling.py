"""From the shaft's receptance H at its ports to what the journals feel, Eqs. 9 to 11.

With P12 = N Z12, P21 = Z21 N^T and H = N^T inv(P11) [N, f] = [Hn, Hf],

    U = P22 - Z21 Hn Z12,    force = F2 - Z21 Hf.
"""

from typing import Any

import numpy as np

from sfd_hbm_ros.kernels import kernel, part
from sfd_hbm_ros.rotor.arrays import ComplexArray, RealArray

_PENCILS = ", ".join(["complex128[:, :, :, ::1]"] * 3)


@part
def _set(members: Any, pencils: Any, s: int, factors: Any, k: int) -> None:
    """Set the member A_0 + c_1 A_1 + ... of a pencil, and its derivative."""
    for order in range(2):
        c_1, c_2, c_3 = factors[order, k, 0], factors[order, k, 1], factors[order, k, 2]
        for i in range(pencils.shape[2]):
            for j in range(pencils.shape[3]):
                member = c_1 * pencils[s, 1, i, j] + c_2 * pencils[s, 2, i, j]
                members[order, i, j] = member + c_3 * pencils[s, 3, i, j]
    for i in range(pencils.shape[2]):
        for j in range(pencils.shape[3]):
            members[0, i, j] += pencils[s, 0, i, j]


@kernel(
    "Tuple((complex128[:, :, :, :, ::1], complex128[:, :, :, ::1]))"
    "(complex128[:, :, :, :, ::1], float64[:, :, ::1], float64[:, :, ::1],"
    f" {_PENCILS}, complex128[:, :, ::1])"
)
def couple(
    receptance: ComplexArray,
    stiffness_factors: RealArray,
    force_factors: RealArray,
    z12: ComplexArray,
    z21: ComplexArray,
    z22: ComplexArray,
    journal_force: ComplexArray,
) -> tuple[ComplexArray, ComplexArray]:
    """Return U and U' (2, m, s, d, d), and the force and its derivative (2, m, s, d).

    Parameters
    ----------
    receptance : (2, m, s, p, p + 2) complex array
        H and its derivative.
    stiffness_factors, force_factors : (2, m, 3), (2, m, 2) arrays
        Those of `sfd_hbm_ros.rotor.factors`.
    z12, z21, z22, journal_force
        Those of a `Partition`.
    """
    _, m, systems, p, _ = receptance.shape
    d = z22.shape[3]
    u = np.empty((2, m, systems, d, d), dtype=np.complex128)
    v = np.zeros((2, m, systems, d), dtype=np.complex128)
    to, back = np.empty((2, d, p), dtype=np.complex128), np.empty((2, p, d), dtype=np.complex128)
    own, x = np.empty((2, d, d), dtype=np.complex128), np.empty((2, p + 2), dtype=np.complex128)
    for k in range(m):
        for s in range(systems):
            _set(to, z21, s, stiffness_factors, k)
            _set(back, z12, s, stiffness_factors, k)
            _set(own, z22, s, stiffness_factors, k)
            for i in range(d):
                for j in range(p + 2):  # a row of Z21 H and its derivative
                    x[:, j] = 0.0
                    for port in range(p):
                        h, h_slope = receptance[0, k, s, port, j], receptance[1, k, s, port, j]
                        x[0, j] += to[0, i, port] * h
                        x[1, j] += to[1, i, port] * h + to[0, i, port] * h_slope
                for j in range(d):
                    value, slope = own[0, i, j], own[1, i, j]
                    for port in range(p):
                        value -= x[0, port] * back[0, port, j]
                        slope -= x[1, port] * back[0, port, j] + x[0, port] * back[1, port, j]
                    u[0, k, s, i, j], u[1, k, s, i, j] = value, slope
                for j in range(2):
                    factor, factor_slope = force_factors[0, k, j], force_factors[1, k, j]
                    felt = journal_force[s, j, i] - x[0, p + j]
                    v[0, k, s, i] += factor * felt
                    v[1, k, s, i] += factor_slope * felt - factor * x[1, p + j]
    return u, v
