"""The harmonic balance equations of a machine, condensed to its journals (Eqs. 2 to 11).

Unknown are the coefficients of the journals' motion, an array (rows, n) with n = 2 coordinates a
damper, flattened row by row. The films' forces are evaluated at time samples and transformed back
(alternating frequency/time), and so are their derivatives: nothing is differenced.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmModel, film_of
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.machine import Machine, MachineError
from sfd_hbm_ros.rotor import Condensation, Condensed, RotorModel, assemble

Array = NDArray[np.float64]

_NEAREST = 1.0 - 1e-9  # eccentricity beyond which no step goes
_ROOM = 0.9  # part of the gap to the clearance that one step may close at any time sample


class HarmonicBalance:
    """A machine made ready for harmonic balance at any speed.

    Parameters
    ----------
    machine : Machine
        The machine; it needs a damper.
    harmonics : Harmonics
        Harmonics of the speed to balance.
    model : RotorModel, optional
        The machine's rotor, where it is assembled already.

    Raises
    ------
    MachineError
        If the machine has no damper.
    """

    def __init__(
        self, machine: Machine, harmonics: Harmonics, model: RotorModel | None = None
    ) -> None:
        if not machine.dampers:
            raise MachineError("must hold at least one damper for harmonic balance", "dampers")
        self.machine = machine
        self.harmonics = harmonics
        self.model: RotorModel = model or assemble(machine)
        self.films: tuple[FilmModel, ...] = tuple(film_of(damper) for damper in machine.dampers)
        self.condensation = Condensation(self.model)

    @cached_property
    def clearances(self) -> Array:
        """Clearance of each journal coordinate [m], (n,)."""
        return np.repeat([film.clearance for film in self.films], 2)

    def at(self, speed: float) -> "Equations":
        """Equations at a rotor speed [rad/s].

        Raises
        ------
        ResonanceError
            If a harmonic meets an undamped resonance of the shaft with its journals held.
        """
        condensed = self.condensation.at(speed, self.harmonics.orders)
        load = np.linalg.norm(self.model.linear_force(speed, self.harmonics.orders))
        force = self.harmonics.coefficients(condensed.force)
        return Equations(self, condensed, force, float(load))

    def response(self, solution: Solution) -> NDArray[np.complex128]:
        """Response of the whole rotor (R1 of Eq. 7, with the journals).

        Returns
        -------
        (k + 1, N) complex array
            Amplitudes of every coordinate of `model` [m, rad], q(t) = Re(Q exp(i w t));
            ``model.stations`` has the coordinates of each station.
        """
        orders = solution.harmonics.orders
        amplitudes = solution.harmonics.amplitudes(solution.coefficients)
        return self.condensation.at(solution.speed, orders).recover(amplitudes)


@dataclass(frozen=True, eq=False)
class Equations:
    """Harmonic balance at one speed: linear x - force - film(x) = 0.

    Attributes
    ----------
    balance : HarmonicBalance
        What is balanced.
    condensed : Condensed
        The rotor as its journals feel it.
    force : (rows, n) array
        Coefficients of the condensed linear force [N].
    load : float
        Norm of all linear forces on the rotor [N], to which residuals are compared.
    """

    balance: HarmonicBalance
    condensed: Condensed
    force: Array
    load: float

    @property
    def speed(self) -> float:
        """Rotor speed [rad/s]."""
        return self.condensed.speed

    @cached_property
    def linear(self) -> Array:
        """Dynamic stiffness over all coefficients [N/m], (rows n, rows n)."""
        return self._flat(self.balance.harmonics.real_matrix(self.condensed.stiffness))

    @cached_property
    def linear_film(self) -> Array:
        """What small motion about the centre adds to `linear` through the films [N/m]."""
        harmonics = self.balance.harmonics
        w = 1j * harmonics.orders * self.speed
        damping = np.repeat([film.centred_damping for film in self.balance.films], 2)
        inertia = np.repeat([film.centred_inertia for film in self.balance.films], 2)
        blocks = np.multiply.outer(w, np.diag(damping)) + np.multiply.outer(w**2, np.diag(inertia))
        return self._flat(harmonics.real_matrix(blocks))

    def with_force(self, force: Array) -> "Equations":
        """The same equations under another linear force (rows, n)."""
        changed = replace(self, force=force)
        changed.__dict__["linear"] = self.linear
        return changed

    def residual(self, x: Array) -> Array:
        """Imbalance of the forces [N], (rows n,), at coefficients x (rows n,) [m]."""
        harmonics = self.balance.harmonics
        film = np.empty_like(self.force)
        for columns, model, motion in self._journals(x):
            film[:, columns] = harmonics.projection @ model.force(*motion)
        return self._imbalance(x, film)

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Residual and its derivative [N/m], (rows n, rows n), by the coefficients."""
        harmonics, w = self.balance.harmonics, self.speed
        e0, e1, e2 = (basis[:, np.newaxis, np.newaxis, :] for basis in harmonics.bases)
        film = np.empty_like(self.force)
        jacobian = self.linear.copy()
        blocks = jacobian.reshape(self.force.shape * 2)
        for columns, model, motion in self._journals(x):
            f = model.linearise(*motion)
            film[:, columns] = harmonics.projection @ f.force
            by_coefficients = (
                f.by_position[..., np.newaxis] * e0
                + f.by_velocity[..., np.newaxis] * (w * e1)
                + f.by_acceleration[..., np.newaxis] * (w * w * e2)
            )
            block = harmonics.projection @ by_coefficients.reshape(harmonics.samples, -1)
            block = block.reshape(harmonics.rows, 2, 2, harmonics.rows)
            blocks[:, columns, :, columns] -= block.transpose(0, 1, 3, 2)
        return self._imbalance(x, film), jacobian

    def slope_by_speed(self, x: Array) -> Array:
        """Derivative of the residual by the speed [N s], (rows n,)."""
        balance, harmonics, w = self.balance, self.balance.harmonics, self.speed
        stiffness, force = balance.condensation.slope(w, harmonics.orders)
        _, e1, e2 = harmonics.bases
        film = np.empty_like(self.force)
        coefficients = x.reshape(self.force.shape)
        for columns, model, motion in self._journals(x):
            q = coefficients[:, columns]
            f = model.linearise(*motion)
            change = np.einsum("tij,tj->ti", f.by_velocity, e1 @ q)
            change += np.einsum("tij,tj->ti", f.by_acceleration, 2.0 * w * (e2 @ q))
            film[:, columns] = harmonics.projection @ change
        linear = self._flat(harmonics.real_matrix(stiffness)) @ x
        slope: Array = linear - (harmonics.coefficients(force) + film).ravel()
        return slope

    def eccentricity(self, x: Array) -> float:
        """Greatest eccentricity of any journal at the time samples."""
        positions = self.balance.harmonics.bases[0] @ (
            x.reshape(self.force.shape) / self.balance.clearances
        )
        pairs = positions.reshape(len(positions), -1, 2)
        return float(np.linalg.norm(pairs, axis=-1).max())

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a step, at most 1, that keeps every time sample off the clearance."""
        basis = self.balance.harmonics.bases[0]
        c = self.balance.clearances[::2]
        start = (basis @ x.reshape(self.force.shape)).reshape(len(basis), -1, 2)
        move = (basis @ step.reshape(self.force.shape)).reshape(len(basis), -1, 2)
        distance = np.linalg.norm(start, axis=-1)
        limit = np.minimum(distance + _ROOM * (c - distance), _NEAREST * c)
        # positive root s of |start + s move| = limit
        a = np.maximum((move**2).sum(axis=-1), np.finfo(float).tiny)
        b = (start * move).sum(axis=-1)
        gap = np.maximum(limit**2 - distance**2, 0.0)
        root = gap / np.maximum(b + np.sqrt(b * b + a * gap), np.finfo(float).tiny)
        return float(min(1.0, root.min()))

    def _journals(self, x: Array) -> Iterator[tuple[slice, FilmModel, tuple[Array, Array, Array]]]:
        """Columns, film and sampled motion (position, velocity, acceleration) of each damper."""
        e0, e1, e2 = self.balance.harmonics.bases
        coefficients = x.reshape(self.force.shape)
        for damper, model in enumerate(self.balance.films):
            columns = slice(2 * damper, 2 * damper + 2)
            q = coefficients[:, columns]
            yield columns, model, (e0 @ q, self.speed * (e1 @ q), self.speed**2 * (e2 @ q))

    def _imbalance(self, x: Array, film: Array) -> Array:
        imbalance: Array = self.linear @ x - (self.force + film).ravel()
        return imbalance

    def _flat(self, blocks: Array) -> Array:
        return blocks.reshape(self.force.size, self.force.size)
