"""The rotor's matrices split into shaft and journals, in the frame that suits it.

Every matrix is a term of the dynamic stiffness P = K + w (i C) + w W (i G) - w^2 M, Eq. 8. The
shaft's part P11 is banded. A journal is tied to its node of the shaft alone, so that P12 = N Z12
and P21 = Z21 N^T, where N picks the few coordinates of the shaft that have a tie: its ports.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray
from sfd_hbm_ros.rotor.frames import Cartesian, Entries, Frame, Whirl, is_axisymmetric
from sfd_hbm_ros.rotor.model import RotorModel

_Systems = Sequence[Sequence[Entries]]  # the four terms of each system


@dataclass(frozen=True, eq=False)
class Partition:
    """A rotor as s systems of equations for its n shaft and d journal coordinates.

    Of each matrix there are the four terms K, i C, i G and M; of the forces, the static one and
    the unbalance's.

    Parameters
    ----------
    frame : Frame
        The coordinates' frame.
    shaft : (s, 4, n, 2 half + 1) complex array
        P11, stored as `sfd_hbm_ros.rotor.banded` has it.
    ports : (p,) array of int
        Coordinates of the shaft to which journals are tied.
    z12, z21, z22 : (s, 4, p, d), (s, 4, d, p), (s, 4, d, d) complex arrays
        The ties, and the journals' own matrix P22.
    shaft_force, journal_force : (s, 2, n), (s, 2, d) complex arrays
        Linear forces.
    """

    frame: Frame
    shaft: ComplexArray
    ports: IndexArray
    z12: ComplexArray
    z21: ComplexArray
    z22: ComplexArray
    shaft_force: ComplexArray
    journal_force: ComplexArray


def partition(model: RotorModel) -> Partition:
    """Return a rotor's parts; forward and backward whirl apart where it is axisymmetric."""
    frame: Frame = Whirl() if is_axisymmetric(model) else Cartesian()
    M, C, G, K = model.matrices
    terms = [frame.entries(matrix) for matrix in (K, C, G, M)]
    for i in (1, 2):
        terms[i] = tuple(one._replace(value=1j * one.value) for one in terms[i])
    systems = list(zip(*terms, strict=True))
    size = model.size // len(systems)
    n = model.shaft_size // len(systems)
    forces = frame.split(np.stack([model.static_force, model.unbalance])).swapaxes(0, 1)
    ports = _ports(systems, n)
    p = len(ports)
    corner = _corner(systems, np.concatenate([ports, np.arange(n, size)]), size)
    z12, z21, z22 = corner[..., :p, p:], corner[..., p:, :p], corner[..., p:, p:]
    arrays = z12, z21, z22, forces[..., :n], forces[..., n:]
    return Partition(frame, _shaft(systems, n), ports, *map(np.ascontiguousarray, arrays))


def _shaft(systems: _Systems, n: int) -> ComplexArray:
    """Return the terms of P11 (s, 4, n, 2 half + 1)."""
    inner = [[_those(one, (one.row < n) & (one.column < n)) for one in terms] for terms in systems]
    half = max(
        int(np.abs(one.row - one.column).max(initial=0)) for terms in inner for one in terms
    )
    bands = np.zeros((len(systems), 4, n, 2 * half + 1), dtype=complex)
    for s, term in np.ndindex(bands.shape[:2]):
        i, j, value = inner[s][term]
        np.add.at(bands[s, term], (j, half + i - j), value)
    return bands


def _ports(systems: _Systems, n: int) -> IndexArray:
    """Return the shaft's coordinates that have entries in P12 or P21."""
    across = [_those(one, (one.row < n) != (one.column < n)) for terms in systems for one in terms]
    found = [np.minimum(one.row, one.column)[one.value != 0.0] for one in across]
    return np.unique(np.concatenate(found)).astype(np.intp)


def _corner(systems: _Systems, places: IndexArray, size: int) -> ComplexArray:
    """Return the rows and columns at some places (p,) of all terms, (s, 4, p, p)."""
    corner = np.zeros((len(systems), 4, len(places), len(places)), dtype=complex)
    position = np.full(size, -1)
    position[places] = np.arange(len(places))
    for s, term in np.ndindex(corner.shape[:2]):
        one = systems[s][term]
        i, j, value = _those(one, (position[one.row] >= 0) & (position[one.column] >= 0))
        np.add.at(corner[s, term], (position[i], position[j]), value)
    return corner


def _those(entries: Entries, kept: NDArray[np.bool_]) -> Entries:
    return Entries(entries.row[kept], entries.column[kept], entries.value[kept])
