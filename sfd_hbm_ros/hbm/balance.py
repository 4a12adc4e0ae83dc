"""The harmonic balance equations of a machine, condensed to its journals (Eqs. 2 to 11).

Unknown are the coefficients of the journals' motion, an array (rows, n) with n = 2 coordinates a
damper, flattened row by row. The films' forces are evaluated at time samples and transformed back
(alternating frequency/time), and so are their derivatives: nothing is differenced.
"""

import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmModel, film_of
from sfd_hbm_ros.hbm.clearance import NARROW, greatest_eccentricity, largest_step
from sfd_hbm_ros.hbm.film_terms import FilmTerms, LatestTerms
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.machine import Machine, MachineError
from sfd_hbm_ros.rotor import Condensation, Condensed, RotorModel, assemble

Array = NDArray[np.float64]


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

    def with_harmonics(self, harmonics: Harmonics) -> "HarmonicBalance":
        """The same machine, on the same condensation, balanced in other harmonics."""
        other = copy.copy(self)
        other.harmonics = harmonics
        return other

    def at(self, speed: float) -> "Equations":
        """Equations at a rotor speed [rad/s].

        Raises
        ------
        ResonanceError
            If a harmonic meets an undamped resonance of the shaft with its journals held.
        """
        condensed = self.condensation.at(speed, self.harmonics.orders)
        load = self.model.load(speed, condensed.orders)
        force = self.harmonics.coefficients(condensed.force)
        return Equations(self, condensed, force, load)

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

    @property
    def scale(self) -> Array:
        """The clearance each coefficient is compared to [m], (rows n,)."""
        return np.tile(self.balance.clearances, len(self.force))

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
        return self._imbalance(x, self._films(x))

    def rotor_force(self, x: Array) -> Array:
        """Force that moves the rotor with the coefficients x [N], (rows n,)."""
        force: Array = self.linear @ x
        return force

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Residual and its derivative [N/m], (rows n, rows n), by the coefficients."""
        films, jacobian = self._films(x), self.linear.copy()
        films.subtract_derivative(jacobian)
        return self._imbalance(x, films), jacobian

    def slope_by_speed(self, x: Array) -> Array:
        """Derivative of the residual by the speed [N s], (rows n,)."""
        harmonics, condensed = self.balance.harmonics, self.condensed
        amplitudes = harmonics.amplitudes(x.reshape(self.force.shape))
        rotor = (condensed.stiffness_slope @ amplitudes[..., np.newaxis])[..., 0]
        linear = harmonics.coefficients(rotor - condensed.force_slope)
        return (linear - self._films(x).slope_by_frequency()).ravel()

    def eccentricity(self, x: Array) -> float:
        """Greatest eccentricity of any journal."""
        coarse = greatest_eccentricity(self._positions(x), self.balance.clearances)
        if not coarse > NARROW:
            return coarse
        return greatest_eccentricity(self._fine_positions(x), self.balance.clearances)

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a step, at most 1, that keeps every journal off the clearance."""
        clearances = self.balance.clearances
        start, move = self._positions(x), self._positions(step)
        part = largest_step(start, move, clearances)
        if not greatest_eccentricity(start + part * move, clearances) > NARROW:
            return part
        return largest_step(self._fine_positions(x), self._fine_positions(step), clearances)

    def _fine_positions(self, x: Array) -> Array:
        positions: Array = self.balance.harmonics.fine_basis @ x.reshape(self.force.shape)
        return positions

    def _positions(self, x: Array) -> Array:
        positions: Array = self.balance.harmonics.bases[0] @ x.reshape(self.force.shape)
        return positions

    @cached_property
    def _films(self) -> LatestTerms:
        harmonics, films = self.balance.harmonics, self.balance.films
        shape = self.force.shape
        return LatestTerms(lambda x: FilmTerms(harmonics, films, self.speed, x.reshape(shape)))

    def _imbalance(self, x: Array, films: FilmTerms) -> Array:
        return self.rotor_force(x) - (self.force + films.force()).ravel()

    def _flat(self, blocks: Array) -> Array:
        return blocks.reshape(self.force.size, self.force.size)
