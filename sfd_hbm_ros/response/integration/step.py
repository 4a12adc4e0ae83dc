"""One implicit time step of a rotor on its films, condensed to the journals.

The accelerations a of all coordinates at a step's stages obey

    M a + (C + W G) (v + h A a) + K (q + h c v + h^2 A^2 a) = f + F(x, x', x''),

with the method's matrix A and nodes c, and the films' forces F on the journals. All but F is
linear in a: one linear solution gives a = free + S F, and Newton's method iterates the
accelerations of the journals alone. The forces of the fluid's inertia are among F.

The drive's torque is taken to act along the bent axis of each disk, so that a changing speed adds
no gyroscopic term of its own. One of another direction would add some (dW/dt)/W^2 of the
gyroscopic moments, 1e-5 of them in a run-up of half a minute.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmModel
from sfd_hbm_ros.response.integration.collocation import Radau
from sfd_hbm_ros.response.integration.ramp import Stages
from sfd_hbm_ros.rotor import RotorModel

Array = NDArray[np.float64]

_ROOM = 0.9  # part of the gap to the clearance that one Newton step may close at any stage


class Motion(NamedTuple):
    """Motion in a step or several: the rotor's at their end, its journals' at times within.

    Attributes
    ----------
    q, v : (N,) arrays
        Displacements [m, rad] and velocities of all coordinates at the end.
    positions, accelerations : (times, n) arrays
        Positions [m] and accelerations of the journals' coordinates.
    """

    q: Array
    v: Array
    positions: Array
    accelerations: Array


class Step:
    """Equations of one step: a `System` of Newton's method in the journals' accelerations.

    Parameters
    ----------
    rotor : RotorModel
        The rotor, of N coordinates, n of them its journals'.
    films : tuple of FilmModel
        The film on each journal.
    radau : Radau
        The method, of s stages.
    stages : Stages
        The step's length, and the speed and the unbalance at its stages.
    q, v : (N,) arrays
        Displacements [m, rad] and velocities at its start.

    Attributes
    ----------
    load : float
        Norm of accelerations [m/s2] to which the imbalance is compared.
    """

    def __init__(
        self,
        rotor: RotorModel,
        films: tuple[FilmModel, ...],
        radau: Radau,
        stages: Stages,
        q: Array,
        v: Array,
    ) -> None:
        self._films, self._radau, self._q, self._v = films, radau, q, v
        self._h, speed, turning = stages
        self._first, self._second = self._h * radau.first, self._h**2 * radau.second
        self._journals = journals = rotor.journals.ravel()
        drift = q + self._h * np.multiply.outer(radau.nodes, v)
        self._drift = drift[:, journals]
        matrix = (
            np.kron(np.eye(radau.stages), rotor.M)
            + np.kron(self._first, rotor.C)
            + np.kron(speed[:, np.newaxis] * self._first, rotor.G)
            + np.kron(self._second, rotor.K)
        )
        force = rotor.static_force + np.multiply.outer(turning, rotor.unbalance).real
        force -= rotor.C @ v + np.multiply.outer(speed, rotor.G @ v) + drift @ rotor.K.T
        units = np.kron(np.eye(radau.stages), np.eye(rotor.size)[:, journals])
        solved = np.linalg.solve(matrix, np.column_stack([force.ravel(), units]))
        self._free, self._flexibility = solved[:, 0], solved[:, 1:]
        rows = np.add.outer(rotor.size * np.arange(radau.stages), journals).ravel()
        self._journal_free, self._journal_flexibility = self._free[rows], self._flexibility[rows]
        scale = min(film.clearance for film in films) * float(speed[0]) ** 2
        self.load = scale * np.sqrt(len(rows))

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Imbalance of the journals' accelerations x (s n,) [m/s2], and its derivative by x."""
        force = np.empty_like(self._drift)
        change = np.zeros(force.shape * 2)
        for columns, film, motion in self._motions(x):
            f = film.linearise(*motion)
            force[:, columns] = f.force
            change[:, columns, :, columns] = (
                np.einsum("ij,ikl->ikjl", np.eye(len(force)), f.by_acceleration)
                + np.einsum("ij,ikl->ikjl", self._first, f.by_velocity)
                + np.einsum("ij,ikl->ikjl", self._second, f.by_position)
            )
        residual = x - self._journal_free - self._journal_flexibility @ force.ravel()
        by_force = self._journal_flexibility @ change.reshape(x.size, x.size)
        return residual, np.eye(x.size) - by_force

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a Newton step, at most 1, that keeps every stage within the clearance."""
        move = self._second @ step.reshape(self._drift.shape)
        part = 1.0
        for columns, film, (position, _, _) in self._motions(x):
            gap = film.clearance - np.linalg.norm(position, axis=1)
            distance = np.linalg.norm(move[:, columns], axis=1)
            part = min(part, _ROOM / max(float((distance / gap).max()), _ROOM))
        return part

    def inside(self, x: Array) -> bool:
        """Whether the journals are within their clearances at every stage."""
        return all(
            bool(np.all(np.linalg.norm(position, axis=1) < film.clearance))
            for _, film, (position, _, _) in self._motions(x)
        )

    def motion(self, x: Array, times: Array) -> Motion:
        """The motion that belongs to the journals' solution x, at times from 0 to 1."""
        force = np.linalg.solve(self._journal_flexibility, x - self._journal_free)
        a = (self._free + self._flexibility @ force).reshape(self._radau.stages, -1)
        own = x.reshape(self._drift.shape)
        drift = np.multiply.outer(times, self._h * self._v[self._journals])
        bend = self._h**2 * self._radau.displacements(times) @ own
        return Motion(
            self._q + self._h * self._v + self._second[-1] @ a,
            self._v + self._first[-1] @ a,
            self._q[self._journals] + drift + bend,
            self._radau.values(times) @ own,
        )

    def last_term(self, x: Array) -> Array:
        """The journals' displacements' last term in the series of the step [m], (n,)."""
        last: Array = self._h**2 * self._radau.last_term @ x.reshape(self._drift.shape)
        return last

    def _motions(self, x: Array) -> Iterator[tuple[slice, FilmModel, tuple[Array, Array, Array]]]:
        """Columns, film and (position, velocity, acceleration) at the stages of each journal."""
        a = x.reshape(self._drift.shape)
        position = self._drift + self._second @ a
        velocity = self._v[self._journals] + self._first @ a
        for damper, film in enumerate(self._films):
            columns = slice(2 * damper, 2 * damper + 2)
            yield columns, film, (position[:, columns], velocity[:, columns], a[:, columns])
