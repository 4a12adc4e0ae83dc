"""Reduction of the rotor to its journals and a few modes (Craig and Bampton 1968)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.linalg import eigh

from sfd_hbm_ros.rotor.arrays import RealArray
from sfd_hbm_ros.rotor.frames import is_axisymmetric
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
    ceiling = 2.0 ** np.ceil(np.log2(highest_frequency))
    frequencies, _ = _basis(model, ceiling)
    return _reduced(model, ceiling, int(np.count_nonzero(frequencies <= highest_frequency)))


@lru_cache(maxsize=16)
def _reduced(model: RotorModel, ceiling: float, modes: int) -> RotorModel:
    """Reduce a rotor to the first of the modes up to a frequency.

    It is kept: along a branch the same modes are wanted again and again.
    """
    frequencies, whole = _basis(model, ceiling)
    basis = np.delete(whole, np.s_[modes : len(frequencies)], axis=1)
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


def hold_journals(model: RotorModel) -> RotorModel:
    """Return the rotor with its journals held: the shaft alone on bearings and ball bearings.

    Its natural frequencies are the poles of the condensed stiffness, Eq. 10.
    """
    n = model.shaft_size
    return RotorModel(
        M=model.M[:n, :n],
        C=model.C[:n, :n],
        G=model.G[:n, :n],
        K=model.K[:n, :n],
        journals=model.journals[:0],
        stations=model.stations,
        unbalance=model.unbalance[:n],
        static_force=model.static_force[:n],
    )


@lru_cache(maxsize=8)
def _basis(model: RotorModel, highest_frequency: float) -> tuple[RealArray, RealArray]:
    """Modes with the journals held, then the static deflection by each journal's unit motion.

    Those of an axisymmetric rotor are of one plane and come in pairs, x and y, so that the
    reduced rotor is axisymmetric in the same way.

    Returns
    -------
    The modes' frequencies (m,) [rad/s], and all columns (N, m + n).
    """
    n, journals = model.shaft_size, model.journals.size
    if is_axisymmetric(model):
        planar, modes = _modes(model.K[:n:2, :n:2], model.M[:n:2, :n:2], highest_frequency)
        frequencies, modes = np.repeat(planar, 2), np.kron(modes, np.eye(2)).astype(float)
    else:
        frequencies, modes = _modes(model.K[:n, :n], model.M[:n, :n], highest_frequency)
    deflections = -np.linalg.solve(model.K[:n, :n], model.K[:n, n:])
    fixed = np.zeros((journals, modes.shape[1]))
    return frequencies, np.block([[modes, deflections], [fixed, np.eye(journals)]])


def _modes(
    stiffness: RealArray, mass: RealArray, highest_frequency: float
) -> tuple[RealArray, RealArray]:
    """Frequencies and columns of the modes; what is skew in a bearing does not shape them."""
    symmetric = 0.5 * (stiffness + stiffness.T)
    squares, modes = eigh(symmetric, mass, subset_by_value=(-np.inf, highest_frequency**2))
    return np.sqrt(np.maximum(squares, 0.0)), np.asarray(modes)
