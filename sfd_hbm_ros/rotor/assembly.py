"""Assembly of a machine's rotor.

Every shaft node has the coordinates (x, y, x', y'), where x' and y' are the rotations of the
cross-section in the planes xz and yz: the slopes dx/dz and dy/dz where shear is small, that is,
rotations about y and about -x. After the shaft's nodes come (x, y) of each damper's journal.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.sparse import csr_array

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, RealArray, SparseArray
from sfd_hbm_ros.rotor.model import Matrices, RotorModel
from sfd_hbm_ros.rotor.parts import parts_of

GRAVITY = 9.80665
"""Standard acceleration of gravity, along -y [m/s2]."""


def assemble(machine: Machine) -> RotorModel:
    """Assemble the rotor of a machine on its bearings, ball bearings and centring springs.

    A damper is a journal, tied to the shaft by the ball bearing and to ground by the centring
    spring; its film is left to the solver. A machine without dampers is a linear rotor.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    RotorModel
        Its matrices and linear forces.
    """
    journals = 4 * machine.nodes + np.arange(2 * len(machine.dampers)).reshape(-1, 2)
    size = 4 * machine.nodes + journals.size
    parts = list(parts_of(machine, journals))
    matrices = Matrices(
        M=_sum([(part.coordinates, part.mass) for part in parts], size),
        C=_sum([(part.coordinates, part.damping) for part in parts], size),
        G=_sum([(part.coordinates, part.gyroscopic) for part in parts], size),
        K=_sum([(part.coordinates, part.stiffness) for part in parts], size),
    )
    stations = {name: 4 * node + np.arange(2) for name, node in machine.stations.items()}
    return RotorModel(
        matrices=matrices,
        journals=journals,
        stations=stations,
        unbalance=_unbalance(machine, stations, size),
        static_force=_static_force(machine, stations, matrices.M),
    )


def _sum(parts: Sequence[tuple[IndexArray, RealArray]], size: int) -> SparseArray:
    """Add up the matrix of each part at its coordinates."""
    rows, columns, entries = [], [], []
    for coordinates, matrix in parts:
        i, j = matrix.nonzero()
        rows.append(coordinates[:, i].ravel())
        columns.append(coordinates[:, j].ravel())
        entries.append(np.broadcast_to(matrix[i, j], (len(coordinates), len(i))).ravel())
    places = np.concatenate(rows), np.concatenate(columns)
    return csr_array((np.concatenate(entries), places), shape=(size, size))


def _unbalance(machine: Machine, stations: Mapping[str, IndexArray], size: int) -> ComplexArray:
    """Return U exp(i p) (1, -i) at each station, which turns from x to y."""
    amplitude = np.zeros(size, dtype=complex)
    for unbalance in machine.unbalance:
        rotating = unbalance.magnitude * np.exp(1j * unbalance.phase) * np.array([1.0, -1.0j])
        amplitude[stations[unbalance.station]] += rotating
    return amplitude


def _static_force(
    machine: Machine, stations: Mapping[str, IndexArray], M: SparseArray
) -> RealArray:
    """Return loads and weight; the mass matrix gives the weight that suits the elements."""
    force = np.zeros(M.shape[0])
    if machine.gravity:
        fall = np.zeros(len(force))
        fall[1 : 4 * machine.nodes : 4] = -GRAVITY
        fall[4 * machine.nodes + 1 :: 2] = -GRAVITY
        force += M @ fall
    for load in machine.loads:
        force[stations[load.station]] += load.force
    return force
