"""Newton-Raphson with a step control that cannot leave the clearance."""

from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

from sfd_hbm_ros.hbm.options import DEFAULTS, NewtonOptions
from sfd_hbm_ros.hbm.time_limit import check_time_limit

Array = NDArray[np.float64]

_DECREASE = 1e-4  # part of the decrease that a straight line promises which a step must reach


class Outcome(Enum):
    """How a solution ended; the value is a sentence about it."""

    CONVERGED = "the forces balance"
    ITERATIONS = "the iteration limit was reached before the forces balanced"
    STALLED = "no step along Newton's direction brought the forces nearer to balance"
    CLEARANCE = "the orbit closed on the clearance"
    SINGULAR = "the Jacobian is singular"
    LOAD = "the load could not be raised to its full value"
    RANGE = "the numbers leave the range of the computer"
    RESONANCE = "a harmonic meets an undamped resonance of the shaft"

    @property
    def converged(self) -> bool:
        """Whether this outcome is a solution."""
        return self is Outcome.CONVERGED


class System(Protocol):
    """Equations that Newton's method can solve."""

    @property
    def load(self) -> float:
        """Norm to which residuals are compared."""

    def linearise(self, x: Array) -> tuple[Array, Array]:
        """Residual at x and its derivative."""

    def largest_step(self, x: Array, step: Array) -> float:
        """Part of a step, at most 1, that keeps x where the residual is defined."""


@dataclass(frozen=True)
class NewtonResult:
    """Where Newton's method ended.

    Attributes
    ----------
    x : (n,) array
        Last accepted unknowns.
    outcome : Outcome
        How it ended.
    residuals : tuple of float
        Norm of the residual relative to the load, at the start and after each step.
    """

    x: Array
    outcome: Outcome
    residuals: tuple[float, ...]


def newton(system: System, x: Array, options: NewtonOptions = DEFAULTS) -> NewtonResult:
    """Solve a system from a start that lies within the clearance.

    Every step is cut to keep a part of the gap to the clearance at every time sample, and halved
    until it reduces the norm of the residual.
    """
    scale = system.load if system.load > 0 else 1.0  # without a load the residual must be zero
    residual, jacobian = system.linearise(x)
    residuals = [float(np.linalg.norm(residual)) / scale]
    outcome = Outcome.ITERATIONS
    for _ in range(options.iterations):
        if residuals[-1] <= options.tolerance:
            break
        _, _, step, singular = dgesv(jacobian, -residual)
        if singular or not np.all(np.isfinite(step)):
            outcome = Outcome.SINGULAR
            break
        allowed = part = system.largest_step(x, step)
        while part > options.shortest_step * allowed:
            check_time_limit()
            residual, jacobian = system.linearise(x + part * step)
            norm = float(np.linalg.norm(residual)) / scale
            if norm < residuals[-1] * (1.0 - _DECREASE * part):
                break
            part *= 0.5
        else:
            outcome = Outcome.STALLED if allowed > options.shortest_step else Outcome.CLEARANCE
            break
        x = x + part * step
        residuals.append(norm)
    if residuals[-1] <= options.tolerance:
        outcome = Outcome.CONVERGED
    return NewtonResult(x, outcome, tuple(residuals))
