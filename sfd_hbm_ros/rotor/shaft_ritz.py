"""Ritz vectors of an undamped shaft at harmonics of the speed, for unit and for linear forces.

The dynamic stiffness is K - W^2 B with B = k^2 M - i k G at the harmonic k; all harmonics are
worked on together. The static force is that of harmonic 0, the unbalance's that of harmonic 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.rotor.arrays import (
    ComplexArray,
    IndexArray,
    NumberArray,
    RealArray,
    SparseArray,
)
from sfd_hbm_ros.rotor.banded import as_sparse
from sfd_hbm_ros.rotor.factors import force_factors
from sfd_hbm_ros.rotor.flexibility import Flexibility, apart, beside
from sfd_hbm_ros.rotor.ritz import Ritz, ritz

_FELT = 1e-12  # relative load below which a Ritz vector may be left out; its square counts
_AT_ONCE = 200_000  # coordinates of all harmonics that are worked on together, for the memory


def shaft_ritz(
    terms: ComplexArray, force: ComplexArray, places: IndexArray, orders: RealArray, highest: float
) -> list[Ritz]:
    """Return the Ritz values (r,) and loads (r, p + 2) of one system for every harmonic.

    Parameters
    ----------
    terms : (4, n, 2 half + 1) complex array
        K, i C, i G and M, stored as `sfd_hbm_ros.rotor.banded` has them.
    force : (2, n) complex array
        The static force and the unbalance's.
    places : (p,) array of int
        Coordinates at which unit forces act.
    orders : (m,) array
        The harmonics.
    highest : float
        Highest speed [rad/s].

    Raises
    ------
    numpy.linalg.LinAlgError
        If the stiffness is not positive definite.
    """
    stiffness, _, gyroscopic, mass = map(_real, terms)
    flexibility, M, iG = Flexibility(stiffness), as_sparse(mass), as_sparse(gyroscopic)
    present = force_factors(1.0, orders, 0.0)[0] != 0.0  # the static force, the unbalance
    found = [Ritz(np.empty(0), np.empty((0, 0)))] * len(orders)
    for group in _groups(present.any(axis=1), len(mass)):
        forces = np.zeros((len(group), len(mass), len(places) + 2), dtype=complex)
        forces[:, places, np.arange(len(places))] = 1.0
        forces[..., -2:] = (present[group, :, np.newaxis] * force).swapaxes(1, 2)
        product = partial(_inertia, M, iG, orders[group])
        pairs = ritz(flexibility, product, _real(forces), highest)
        for k, values, loads in zip(group, *pairs, strict=True):
            sizes = np.linalg.norm(loads, axis=1)
            felt = sizes > _FELT * sizes.max(initial=0.0)
            found[k] = Ritz(values[felt], loads[felt])
    return found


def _groups(forced: NDArray[np.bool_], n: int) -> Iterator[IndexArray]:
    """Yield the harmonics with linear forces, then those without, so many as memory holds."""
    for kind in (forced, ~forced):
        group = np.flatnonzero(kind)
        parts = -(-len(group) * n // _AT_ONCE)
        yield from np.array_split(group, parts) if parts else ()


def _inertia(
    M: SparseArray, iG: SparseArray, orders: RealArray, vectors: NumberArray
) -> NumberArray:
    """Return B x for a block x (n, columns) of each harmonic (m, n, columns)."""
    k, columns = orders[:, np.newaxis, np.newaxis], beside(vectors)
    return k * k * apart(M @ columns, len(k)) - k * apart(iG @ columns, len(k))


def _real(array: NumberArray) -> NumberArray:
    """Return a real array where all is real: half of the work."""
    return array if array.imag.any() else np.ascontiguousarray(array.real)
