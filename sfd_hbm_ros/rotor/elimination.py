"""The shaft's receptance at its ports by elimination, at many frequencies in one call.

The receptance is H = N^T inv(P11) [N, f] for unit forces at the ports and for the linear forces
f. P11 = A_0 + c_1 A_1 + c_2 A_2 + c_3 A_3; with Y = N^T inv(P11) and a dash for the derivative by
whatever the c vary with,

    H = Y [N, f],    H' = Z [N, f],    Z = -Y P11' inv(P11),

so that one banded factorisation of P11, transposed, serves values and derivatives alike.
"""

import numpy as np

from sfd_hbm_ros.rotor import banded
from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, NumberArray, RealArray


def eliminate(
    shaft: ComplexArray, ports: IndexArray, forces: ComplexArray, coefficients: RealArray
) -> ComplexArray:
    """Return the receptance of s systems for m sets of coefficients, and its derivative.

    Parameters
    ----------
    shaft, ports, forces
        `shaft`, `ports` and `shaft_force` of a `Partition`.
    coefficients : (2, m, 3) array
        The c of each set, then their derivatives.

    Returns
    -------
    H and H' (2, m, s, p, p + 2).

    Raises
    ------
    banded.SingularSystemError
        If a P11 is singular; its index counts the systems of each set after another.
    """
    varying, slope = np.tensordot(coefficients, shaft[:, 1:], (2, 1))
    factorised = banded.Factorised(shaft[:, 0] + varying)
    sets, systems, n, _ = slope.shape
    units = np.zeros((sets, systems, n, len(ports)), dtype=complex)
    units[..., ports, np.arange(len(ports))] = 1.0
    y = factorised.solve_transposed(units)
    z = factorised.solve_transposed(-banded.transposed_product(slope, y))
    return np.stack([_seen(one, ports, forces) for one in (y, z)])


def _seen(columns: NumberArray, ports: IndexArray, forces: ComplexArray) -> NumberArray:
    """Return Y [N, f] of Y^T (m, s, n, p)."""
    rows = columns.swapaxes(-1, -2)
    return np.concatenate([rows[..., ports], rows @ forces.swapaxes(-1, -2)], axis=-1)
