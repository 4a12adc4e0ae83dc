"""Assembly of a machine's rotor.

Every shaft node has the coordinates (x, y, x', y'), where x' and y' are the rotations of the
cross-section in the planes xz and yz: the slopes dx/dz and dy/dz where shear is small, that is,
rotations about y and about -x. After the shaft's nodes come (x, y) of each damper's journal.

An axisymmetric part has the same matrix A in both planes and enters as A (x) I. The speed W turns
x into y; with b = x' + i y' a disk of inertias Id and Ip obeys Id b'' - i W Ip b' = moment, so
that a polar inertia A enters the gyroscopic matrix as A (x) [[0, 1], [-1, 0]].
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.rotor.arrays import ComplexArray, IndexArray, RealArray
from sfd_hbm_ros.rotor.elements import BeamElement, beam_element
from sfd_hbm_ros.rotor.model import RotorModel

GRAVITY = 9.80665
"""Standard acceleration of gravity, along -y [m/s2]."""

_BETWEEN = np.array([[1.0, -1.0], [-1.0, 1.0]])
"""A unit spring between two coordinates."""


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
    planar = _planar_matrices(machine)
    M, C, K = (
        np.kron(matrix, np.eye(2)).astype(float)
        for matrix in (planar.mass, planar.damping, planar.stiffness)
    )
    for bearing in machine.bearings:
        x_y = slice(4 * bearing.node, 4 * bearing.node + 2)
        C[x_y, x_y] += bearing.damping
        K[x_y, x_y] += bearing.stiffness
    stations = {name: 4 * node + np.arange(2) for name, node in machine.stations.items()}
    return RotorModel(
        M=M,
        C=C,
        G=np.kron(planar.polar, [[0.0, 1.0], [-1.0, 0.0]]).astype(float),
        K=K,
        journals=np.arange(4 * machine.nodes, len(M)).reshape(-1, 2),
        stations=stations,
        unbalance=_unbalance(machine, stations, len(M)),
        static_force=_static_force(machine, stations, M),
    )


class _Planar(NamedTuple):
    """Matrices of all but the bearings in one plane: (v, r) of every node, v of every journal."""

    mass: RealArray
    polar: RealArray
    damping: RealArray
    stiffness: RealArray


def _planar_matrices(machine: Machine) -> _Planar:
    """Return the matrices of shaft, disks and dampers in one plane."""
    journals = 2 * machine.nodes
    size = journals + len(machine.dampers)
    planar = _Planar(*np.zeros((4, size, size)))
    for first, element in _elements(machine):
        span = slice(first, first + 4)
        planar.mass[span, span] += element.mass
        planar.polar[span, span] += element.gyroscopic
        planar.stiffness[span, span] += element.stiffness
    for disk in machine.disks:
        v, r = 2 * disk.node, 2 * disk.node + 1
        planar.mass[v, v] += disk.mass
        planar.mass[r, r] += disk.diametral_inertia
        planar.polar[r, r] += disk.polar_inertia
    for journal, damper in enumerate(machine.dampers, start=journals):
        ends = np.ix_([2 * damper.node, journal], [2 * damper.node, journal])
        planar.mass[journal, journal] += damper.journal_mass
        planar.damping[ends] += damper.bearing_damping * _BETWEEN
        planar.stiffness[ends] += damper.bearing_stiffness * _BETWEEN
        planar.stiffness[journal, journal] += damper.centering_stiffness
    return planar


def _elements(machine: Machine) -> Iterator[tuple[int, BeamElement]]:
    """Yield the shaft's elements with the planar coordinate at which each begins."""
    first = 0
    for segment in machine.shaft:
        element = beam_element(segment)
        for _ in range(segment.elements):
            yield first, element
            first += 2


def _unbalance(machine: Machine, stations: Mapping[str, IndexArray], size: int) -> ComplexArray:
    """Return U exp(i p) (1, -i) at each station, which turns from x to y."""
    amplitude = np.zeros(size, dtype=complex)
    for unbalance in machine.unbalance:
        rotating = unbalance.magnitude * np.exp(1j * unbalance.phase) * np.array([1.0, -1.0j])
        amplitude[stations[unbalance.station]] += rotating
    return amplitude


def _static_force(machine: Machine, stations: Mapping[str, IndexArray], M: RealArray) -> RealArray:
    """Return loads and weight; the mass matrix gives the weight that suits the elements."""
    force = np.zeros(len(M))
    if machine.gravity:
        fall = np.zeros(len(M))
        fall[1 : 4 * machine.nodes : 4] = -GRAVITY
        fall[4 * machine.nodes + 1 :: 2] = -GRAVITY
        force += M @ fall
    for load in machine.loads:
        force[stations[load.station]] += load.force
    return force
