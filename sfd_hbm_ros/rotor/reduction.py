"""Reduction of the rotor to its journals and a few modes (Craig and Bampton 1968)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import splu

from sfd_hbm_ros.rotor.arrays import NumberArray, RealArray, SparseArray
from sfd_hbm_ros.rotor.frames import Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.model import Matrices, RotorModel
from sfd_hbm_ros.rotor.spectrum import lowest_modes


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
        matrices=Matrices(*(csr_array(basis.T @ (part @ basis)) for part in model.matrices)),
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
        matrices=Matrices(*(matrix[:n, :n] for matrix in model.matrices)),
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
    M, K, ties = model.matrices.M[:n, :n], model.matrices.K[:n, :n], model.matrices.K[:n, n:]
    symmetric = 0.5 * (K + K.T)  # what is skew in a bearing does not shape the modes
    if is_axisymmetric(model):
        planar, modes = lowest_modes(symmetric[::2, ::2], M[::2, ::2], highest_frequency)
        frequencies, modes = np.repeat(planar, 2), _in_both_planes(modes)
        pulled = _in_both_planes(_solved(Whirl().systems(K)[0], Whirl().systems(ties)[0]))
    else:
        frequencies, modes = lowest_modes(symmetric, M, highest_frequency)
        pulled = _solved(K, ties).real
    fixed = np.zeros((journals, modes.shape[1]))
    return frequencies, np.block([[modes, -pulled], [fixed, np.eye(journals)]])


def _solved(matrix: SparseArray, columns: SparseArray) -> NumberArray:
    """Return inv(A) B."""
    return np.asarray(splu(matrix.tocsc()).solve(columns.toarray()))


def _in_both_planes(forward: NumberArray) -> RealArray:
    """Return the matrix of blocks [[p, q], [-q, p]] whose forward whirl has p - i q."""
    turning = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return np.asarray(np.kron(forward.real, np.eye(2)) - np.kron(forward.imag, turning), float)
