"""Factors by which matrices and forces enter the equations of each harmonic, Eq. 8.

Each comes with its derivative, while the speed changes at the rate `speed_change` and all orders
at the rate `order_change`: (1, 0) for the derivative by the speed, (0, 1) for that by the order.
"""

import numpy as np

from sfd_hbm_ros.kernels import kernel
from sfd_hbm_ros.rotor.arrays import RealArray


@kernel("float64[:, :, ::1](float64, float64[::1], float64, float64)")
def stiffness_factors(
    speed: float, orders: RealArray, speed_change: float, order_change: float
) -> RealArray:
    """Return those of i C, i G and M beside K, then their derivatives, (2, m, 3)."""
    factors = np.empty((2, len(orders), 3))
    for k in range(len(orders)):
        w = orders[k] * speed
        change = orders[k] * speed_change + order_change * speed
        factors[0, k, 0], factors[1, k, 0] = w, change
        factors[0, k, 1], factors[1, k, 1] = w * speed, change * speed + w * speed_change
        factors[0, k, 2], factors[1, k, 2] = -w * w, -2.0 * w * change
    return factors


@kernel("float64[:, :, ::1](float64, float64[::1], float64)")
def force_factors(speed: float, orders: RealArray, speed_change: float) -> RealArray:
    """Return those of the static force and the unbalance, then their derivatives, (2, m, 2)."""
    factors = np.zeros((2, len(orders), 2))
    for k in range(len(orders)):
        if orders[k] == 0.0:
            factors[0, k, 0] = 1.0
        elif orders[k] == 1.0:
            factors[0, k, 1], factors[1, k, 1] = speed * speed, 2.0 * speed * speed_change
    return factors
