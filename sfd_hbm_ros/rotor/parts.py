"""What each part of a rotor adds to its matrices, in the coordinates of the assembly.

An axisymmetric part has the same matrix A in both planes and enters as A (x) I. The speed W turns
x into y; with b = x' + i y' a disk of inertias Id and Ip obeys Id b'' - i W Ip b' = moment, so
that a polar inertia A enters the gyroscopic matrix as A (x) [[0, 1], [-1, 0]].
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.rotor.arrays import IndexArray, RealArray
from sfd_hbm_ros.rotor.elements import beam_element

_BETWEEN = np.array([[1.0, -1.0], [-1.0, 1.0]])
"""A unit spring between two coordinates."""

_NOTHING = np.zeros((1, 1))


class Parts(NamedTuple):
    """Equal parts of the rotor: the coordinates (parts, n) of each, and what it adds there."""

    coordinates: IndexArray
    mass: RealArray = _NOTHING
    damping: RealArray = _NOTHING
    gyroscopic: RealArray = _NOTHING
    stiffness: RealArray = _NOTHING


def parts_of(machine: Machine, journals: IndexArray) -> Iterator[Parts]:
    """Yield all parts of a rotor whose journals have the coordinates (dampers, 2)."""
    yield from _shaft(machine)
    yield from _disks(machine)
    yield from _supports(machine, journals)


def _shaft(machine: Machine) -> Iterator[Parts]:
    """Yield the elements of each segment."""
    first = 0
    for segment in machine.shaft:
        element = beam_element(segment)
        yield Parts(
            4 * (first + np.arange(segment.elements))[:, np.newaxis] + np.arange(8),
            mass=_in_both_planes(element.mass),
            gyroscopic=_turning(element.gyroscopic),
            stiffness=_in_both_planes(element.stiffness),
        )
        first += segment.elements


def _disks(machine: Machine) -> Iterator[Parts]:
    """Yield the disks."""
    for disk in machine.disks:
        yield Parts(
            4 * disk.node + np.arange(4)[np.newaxis],
            mass=_in_both_planes(np.diag([disk.mass, disk.diametral_inertia])),
            gyroscopic=_turning(np.diag([0.0, disk.polar_inertia])),
        )


def _supports(machine: Machine, journals: IndexArray) -> Iterator[Parts]:
    """Yield the bearings, and the dampers with their ball bearings and centring springs."""
    for bearing in machine.bearings:
        x_y = 4 * bearing.node + np.arange(2)[np.newaxis]
        damping, stiffness = np.array(bearing.damping), np.array(bearing.stiffness)
        yield Parts(x_y, damping=damping, stiffness=stiffness)
    for damper, journal in zip(machine.dampers, journals, strict=True):
        shaft = 4 * damper.node + np.arange(2)
        yield Parts(
            np.concatenate([shaft, journal])[np.newaxis],
            damping=_in_both_planes(damper.bearing_damping * _BETWEEN),
            stiffness=_in_both_planes(damper.bearing_stiffness * _BETWEEN),
        )
        yield Parts(
            journal[np.newaxis],
            mass=damper.journal_mass * np.eye(2),
            stiffness=damper.centering_stiffness * np.eye(2),
        )


def _in_both_planes(planar: RealArray) -> RealArray:
    return _kronecker(planar, np.eye(2))


def _turning(planar: RealArray) -> RealArray:
    return _kronecker(planar, np.array([[0.0, 1.0], [-1.0, 0.0]]))


def _kronecker(one: RealArray, other: RealArray) -> RealArray:
    """Return what `numpy.kron` does, ten times sooner for small matrices."""
    product = one[:, np.newaxis, :, np.newaxis] * other[np.newaxis, :, np.newaxis, :]
    return product.reshape(2 * len(one), -1)
