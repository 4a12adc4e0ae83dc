"""Reduction of the rotor to its journals and a few modes (Craig and Bampton 1968)."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from sfd_hbm_ros.rotor.arrays import RealArray
from sfd_hbm_ros.rotor.model import RotorModel


def reduce_model(model: RotorModel, highest_frequency: float) -> RotorModel:
    """Reduce a rotor to its journals' coordinates and its lowest modes with the journals held.

    The journals' static flexibility is exact. At a frequency w the reduced dynamic stiffness errs
    relatively with about the square of w over the first left out frequency.

    Parameters
    ----------
    model : RotorModel
        The rotor.
    highest_frequency : float
        Modes up to this natural frequency are kept [rad/s].

    Returns
    -------
    RotorModel
        The reduced rotor: coordinates of the modes, then (x, y) of every journal. Its stations
        are left out, as it has no coordinates there.
    """
    basis = _basis(model, highest_frequency)
    modes = basis.shape[1] - model.journals.size
    return RotorModel(
        M=basis.T @ model.M @ basis,
        C=basis.T @ model.C @ basis,
        G=basis.T @ model.G @ basis,
        K=basis.T @ model.K @ basis,
        journals=modes + np.arange(model.journals.size).reshape(-1, 2),
        stations={},
        unbalance=basis.T @ model.unbalance,
        static_force=basis.T @ model.static_force,
    )


def _basis(model: RotorModel, highest_frequency: float) -> RealArray:
    """Modes with the journals held, then the static deflection by each journal's unit motion."""
    n = model.shaft_size
    stiffness, coupling = _symmetric(model.K[:n, :n]), model.K[:n, n:]
    squares = (-np.inf, highest_frequency**2)
    _, modes = eigh(stiffness, model.M[:n, :n], subset_by_value=squares)
    deflections = -np.linalg.solve(model.K[:n, :n], coupling)
    return np.block(
        [
            [modes, deflections],
            [np.zeros((model.size - n, modes.shape[1])), np.eye(model.size - n)],
        ]
    )


def _symmetric(matrix: RealArray) -> RealArray:
    """Symmetric part: a bearing's stiffness may have another, which does not shape the modes."""
    return 0.5 * (matrix + matrix.T)
