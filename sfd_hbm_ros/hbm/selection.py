"""Choice of the harmonics that matter, out of a trial group from sub- to super-harmonics.

A solution of a few harmonics is put into the equations of the whole trial group. One step of
Newton's method there tells what the harmonics left out would add: by the Newton-Kantorovich
theorem (Deuflhard 2011, Newton Methods for Nonlinear Problems, sec. 2.1) the solution of the trial
group lies within twice that step as long as the following one is at most half as long. Harmonics
that would add much come in; those far below go out, so that the group does not flicker.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.options import OptionError
from sfd_hbm_ros.hbm.solve import solve_equations
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_SHARE = 0.2  # of the tolerance that one harmonic may add before it is taken in
_LEAVE = 0.02  # of the tolerance below which a harmonic goes out again


@dataclass(frozen=True)
class Neglect:
    """What a group of harmonics leaves out, against the trial group.

    Attributes
    ----------
    by_order : (orders,) array
        Amplitude that each harmonic of the trial group would change by, of the clearance.
    error : float
        Bound of the distance of any journal from the trial group's solution, of the clearance:
        twice the step of Newton's method.
    """

    by_order: Array
    error: float


class SelectedBalance:
    """A machine balanced in those harmonics of a trial group that matter.

    Parameters
    ----------
    machine : Machine
        The machine.
    trial : Harmonics
        The trial group.
    tolerance : float
        Distance from the trial group's solution that is allowed, of the clearance.

    Raises
    ------
    OptionError
        If the tolerance is not positive.
    """

    def __init__(self, machine: Machine, trial: Harmonics, tolerance: float = 1e-4) -> None:
        if not tolerance > 0.0:
            raise OptionError(f"tolerance: {tolerance} is not allowed, it must be positive")
        self.full = HarmonicBalance(machine, trial)
        self.trial = trial
        self.tolerance = tolerance
        self._balances: dict[tuple[int, ...], HarmonicBalance] = {}

    @property
    def least(self) -> tuple[int, ...]:
        """The smallest group: mean and the order of the speed."""
        return (0, self.trial.revolutions)

    def balance(self, group: tuple[int, ...]) -> HarmonicBalance:
        """The machine balanced in a group of the trial group's multiples."""
        if group not in self._balances:
            self._balances[group] = self.full.with_harmonics(self.trial.only(group))
        return self._balances[group]

    @one_blas_thread
    def neglect(self, group: tuple[int, ...], speed: float, x: Array) -> Neglect:
        """What a group's solution x at a speed [rad/s] leaves out; the trial group's, nothing."""
        if group == self.trial.multiples:
            return Neglect(np.zeros(len(group)), 0.0)
        equations = self.full.at(speed)
        embedded = self.embed(group, x)
        residual, jacobian = equations.linearise(embedded)
        try:
            step: Array = np.linalg.solve(jacobian, -residual).astype(float)
        except np.linalg.LinAlgError:  # at a fold, where nothing bounds what is left out
            return Neglect(np.full(len(self.trial.multiples), np.inf), np.inf)
        scaled = step.reshape(equations.force.shape) / self.full.clearances
        amplitudes = np.abs(self.trial.amplitudes(scaled)).max(axis=1)
        return Neglect(amplitudes, 2.0 * equations.eccentricity(step))

    def embed(self, group: tuple[int, ...], x: Array) -> Array:
        """A group's coefficients as those of the trial group, flat."""
        harmonics = self.trial.only(group)
        shaped = x.reshape(harmonics.rows, -1)
        return self.trial.change_from(harmonics, shaped).ravel()

    def adapt(self, group: tuple[int, ...], x: Array, neglect: Neglect) -> tuple[int, ...]:
        """The group with what matters taken in, or what has ceased to matter left out.

        A group that leaves out too much grows, up to the trial group.
        """
        inside = np.isin(self.trial.multiples, group)
        if neglect.error > self.tolerance:
            added = np.where(inside, 0.0, neglect.by_order)
            grown = inside | (added >= min(_SHARE * self.tolerance, 0.5 * added.max()))
            return tuple(np.array(self.trial.multiples)[grown].tolist())
        shaped = self.embed(group, x).reshape(self.trial.rows, -1) / self.full.clearances
        present = np.abs(self.trial.amplitudes(shaped)).max(axis=1)
        keep = inside & (present > _LEAVE * self.tolerance)
        keep |= np.isin(self.trial.multiples, self.least)
        return tuple(np.array(self.trial.multiples)[keep].tolist())

    @one_blas_thread
    def solve(self, speed: float) -> tuple[tuple[int, ...], Array, Neglect]:
        """Group, coefficients and what is neglected of the response at a speed [rad/s].

        Raises
        ------
        ArithmeticError
            If no solution was found.
        """
        group, guess = self.least, None
        while True:
            equations = self.balance(group).at(speed)
            result = newton(equations, guess) if guess is not None else None
            if result is None or not result.outcome.converged:
                result, message = solve_equations(equations)
                if not result.outcome.converged:
                    raise ArithmeticError(message)
            neglect = self.neglect(group, speed, result.x)
            if neglect.error <= self.tolerance:
                return group, result.x, neglect
            larger = self.adapt(group, result.x, neglect)
            guess = self.regroup(group, larger, result.x)
            group = larger

    def regroup(self, group: tuple[int, ...], other: tuple[int, ...], x: Array) -> Array:
        """A group's coefficients as those of another, flat."""
        one, two = self.trial.only(group), self.trial.only(other)
        return two.change_from(one, x.reshape(one.rows, -1)).ravel()
