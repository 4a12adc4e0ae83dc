"""Time integration of a machine's motion, revolution by revolution."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, NewtonOptions, Solution
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.response.integration.collocation import Radau
from sfd_hbm_ros.response.integration.options import DEFAULTS, SAMPLES, IntegrationOptions
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.step import Motion, Step
from sfd_hbm_ros.rotor import Condensation, reduce_model
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_REACH = 50.0
"""Multiple of the speed up to which the rotor's modes with the journals held are kept: the motion
near a resonance errs by some tenths of a percent of the clearance with 20, by 1e-5 with 50."""

_SHORTEST = 2.0**-12  # part of a revolution below which a step is not halved again


class ClearanceError(ArithmeticError):
    """No step, however short, leads on from a journal that closes on its clearance."""


@dataclass(frozen=True, eq=False)
class State:
    """Motion of a reduced rotor of N coordinates, n of them its journals', at angle 0.

    Attributes
    ----------
    displacement, velocity : (N,) arrays
        Displacements [m, rad] and velocities.
    expected : (steps, stages, n) array
        Accelerations of the journals that the next revolution is expected to have [m/s2], where
        Newton's method begins.
    """

    displacement: Array
    velocity: Array
    expected: Array


@dataclass(frozen=True, eq=False)
class _Part:
    """A part of a run, from `start` over `width` [revolutions], and times asked for within it."""

    ramp: Ramp
    start: float
    width: float
    times: Array

    def halves(self) -> tuple["_Part", "_Part"]:
        """Both halves, with the times that fall into each."""
        early, half = self.times < 0.5, 0.5 * self.width
        return (
            _Part(self.ramp, self.start, half, 2.0 * self.times[early]),
            _Part(self.ramp, self.start + half, half, 2.0 * self.times[~early] - 1.0),
        )


class Integrator:
    """Integrates a machine's motion.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine.
    highest_speed : float
        Highest speed that it will run at [rad/s].
    options : IntegrationOptions
        Settings.
    """

    def __init__(
        self,
        balance: HarmonicBalance,
        highest_speed: float,
        options: IntegrationOptions = DEFAULTS,
    ) -> None:
        self.balance, self.options = balance, options
        self.rotor = reduce_model(balance.model, _REACH * highest_speed)
        self.radau = Radau(options.stages)
        self._newton = NewtonOptions(tolerance=options.tolerance)
        samples = np.arange(SAMPLES // options.steps) * (options.steps / SAMPLES)
        self._times = np.sort(np.concatenate([samples, self.radau.nodes]))
        self._is_node = np.isin(self._times, self.radau.nodes)

    @one_blas_thread
    def start(self, solution: Solution) -> State:
        """The motion of a harmonic balance solution."""
        orders, w = solution.harmonics.orders, solution.speed
        journals = solution.harmonics.amplitudes(solution.coefficients)
        amplitudes = Condensation(self.rotor).at(w, orders).recover(journals)
        steps = self.options.steps
        angle = 2.0 * np.pi / steps * np.add.outer(np.arange(steps), self.radau.nodes)
        second = w**2 * solution.harmonics.basis_at(angle.ravel(), 2) @ solution.coefficients
        return State(
            amplitudes.real.sum(axis=0),
            (1j * w * orders @ amplitudes).real,
            second.reshape(*angle.shape, -1),
        )

    @one_blas_thread
    def revolution(self, ramp: Ramp, number: int, state: State) -> tuple[State, Array]:
        """Integrate over one revolution of a run; they are counted from 0.

        Returns
        -------
        The state at its end, and the journals' positions [m] at equal distances in time within
        each step, from the revolution's start on, (SAMPLES, n).

        Raises
        ------
        ClearanceError
            If a journal closes on its clearance.
        """
        steps = self.options.steps
        q, v = state.displacement, state.velocity
        expected, positions = np.empty_like(state.expected), []
        for i, guess in enumerate(state.expected):
            part = _Part(ramp, number + i / steps, 1.0 / steps, self._times)
            motion = self._advance(part, q, v, guess)
            q, v = motion.q, motion.v
            expected[i] = motion.accelerations[self._is_node]
            positions.append(motion.positions[~self._is_node])
        return State(q, v, expected), np.concatenate(positions)

    def _advance(self, part: _Part, q: Array, v: Array, guess: Array) -> Motion:
        """Integrate over a part of the run in one step, or in two halves if that is too long."""
        radau, films = self.radau, self.balance.films
        stages = part.ramp.stages(part.start, part.width, radau.nodes)
        step = Step(self.rotor, films, radau, stages, q, v)
        if step.inside(guess):
            result = newton(step, guess.ravel(), self._newton)
            if result.outcome.converged and self._resolved(step, result.x):
                return step.motion(result.x, part.times)
        if part.width < _SHORTEST:
            raise ClearanceError("a journal closed on its clearance")
        early, late = part.halves()
        first = self._advance(early, q, v, radau.values(0.5 * radau.nodes) @ guess)
        second = self._advance(
            late, first.q, first.v, radau.values(0.5 + 0.5 * radau.nodes) @ guess
        )
        return Motion(
            second.q,
            second.v,
            np.concatenate([first.positions, second.positions]),
            np.concatenate([first.accelerations, second.accelerations]),
        )

    def _resolved(self, step: Step, x: Array) -> bool:
        limit = self.options.resolution * self.balance.clearances
        return bool(np.all(np.abs(step.last_term(x)) <= limit))
