"""Run-ups and coast-downs in time, which show by themselves where a machine jumps."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, solve
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.integrator import ClearanceError, Integrator, State
from sfd_hbm_ros.response.integration.options import DEFAULTS, IntegrationOptions
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.threads import one_blas_thread
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]
Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Transient:
    """A run of a machine in time, over m revolutions.

    Attributes
    ----------
    ramp : Ramp
        The rotor's speed.
    eccentricity_max, eccentricity_mean : mapping of str to (m,) array
        Greatest and mean eccentricity in each revolution, by the damper's name.
    orbit : mapping of str to (samples, 2) array
        Positions of each journal in the last revolution [m].
    state : State
        The motion at its end, from which another run can start.
    """

    ramp: Ramp
    eccentricity_max: dict[str, Array]
    eccentricity_mean: dict[str, Array]
    orbit: dict[str, Array]
    state: State

    @property
    def time(self) -> Array:
        """Time in the middle of each revolution [s], (m,)."""
        return self.ramp.time(self._middle)

    @property
    def speed(self) -> Array:
        """Rotor speed in the middle of each revolution [rad/s], (m,)."""
        return self.ramp.speed(self._middle)

    @property
    def worst_eccentricity(self) -> Array:
        """Greatest eccentricity of any damper in each revolution, (m,)."""
        every = np.array(list(self.eccentricity_max.values()))
        worst: Array = every.max(axis=0)
        return worst

    @property
    def _middle(self) -> Array:
        """Revolutions up to the middle of each."""
        return np.arange(0.5, self.ramp.revolutions)


@one_blas_thread
def simulate(
    balance: HarmonicBalance,
    start: float,
    end: float,
    rate: float,
    options: IntegrationOptions = DEFAULTS,
    progress: Progress | None = None,
) -> Transient:
    """Run a machine up or down, from the harmonic balance solution at the start on.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine, and the harmonics of the start.
    start, end : float
        Speeds [rad/s]; a lower end is a coast-down.
    rate : float
        Rate of the speed [rad/s2], positive.
    options : IntegrationOptions
        Settings of the integration.
    progress : callable, optional
        Called with the speed [rad/s] after each revolution.

    Raises
    ------
    ValueError
        If a number is not positive and finite, or the run is shorter than a revolution.
    NoSolutionError
        If harmonic balance finds no solution at the start, or a journal closes on its clearance.
    """
    ramp = Ramp.between(start, end, rate)
    solution = solve(balance, start)
    if not solution.converged:
        rpm = start / RPM
        raise NoSolutionError(f"no solution to start from at {rpm:g} rpm: {solution.message}")
    integrator = Integrator(balance, max(start, end), options)
    return run(integrator, ramp, integrator.start(solution), progress)


@one_blas_thread
def run(
    integrator: Integrator, ramp: Ramp, state: State, progress: Progress | None = None
) -> Transient:
    """Run a machine from any state; errors are those of `simulate`."""
    dampers = integrator.balance.machine.dampers
    names = [damper.name for damper in dampers]
    clearances = np.array([damper.clearance for damper in dampers])
    ends = ramp.speed(np.arange(1.0, ramp.revolutions + 1.0))
    shape = ramp.revolutions, len(dampers)
    greatest, mean = np.empty(shape), np.empty(shape)
    for number, speed in enumerate(ends.tolist()):
        try:
            state, positions = integrator.revolution(ramp, number, state)
        except ClearanceError as error:
            raise NoSolutionError(f"{error}, at {speed / RPM:g} rpm") from error
        orbit = positions.reshape(len(positions), -1, 2)
        eccentricity = np.linalg.norm(orbit, axis=-1) / clearances
        greatest[number], mean[number] = eccentricity.max(axis=0), eccentricity.mean(axis=0)
        if progress is not None:
            progress(speed)
    return Transient(
        ramp,
        dict(zip(names, greatest.T, strict=True)),
        dict(zip(names, mean.T, strict=True)),
        dict(zip(names, orbit.swapaxes(0, 1), strict=True)),
        state,
    )
