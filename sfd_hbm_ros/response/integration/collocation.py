"""Radau's implicit Runge-Kutta methods for second-order equations."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.options import OptionError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Radau:
    """Radau IIA method with s stages (Hairer and Wanner 1996, Solving ODEs II, IV.5).

    The last stage lies at the end of the step. There the method is of order 2s - 1, and it is
    L-stable. Time is counted in steps, from 0 to 1.

    Parameters
    ----------
    stages : int
        Number s of stages, at least 2.

    Raises
    ------
    OptionError
        If the number is below 2.
    """

    stages: int

    def __post_init__(self) -> None:
        if self.stages < 2:
            raise OptionError(f"stages: {self.stages} is not allowed, it must be at least 2")

    @cached_property
    def nodes(self) -> Array:
        """Times of the stages, (s,), rising to 1."""
        series = np.zeros(self.stages + 1)
        series[-2:] = 1.0, -1.0  # P_(s-1) - P_s
        nodes: Array = 0.5 * (1.0 + legendre.legroots(series).real)
        nodes[-1] = 1.0
        return nodes

    @cached_property
    def first(self) -> Array:
        """Matrix A of the method, (s, s), from accelerations to velocities at the stages."""
        return self._integral(self.nodes)

    @cached_property
    def second(self) -> Array:
        """Matrix A^2, (s, s), from accelerations to displacements at the stages."""
        second: Array = self.first @ self.first
        return second

    @cached_property
    def last_term(self) -> Array:
        """Vector (s,) from accelerations at the stages to the last term of the displacements.

        That is what the highest of Legendre's polynomials contributes. Of a motion whose terms
        fall quickly it shows the error within the step.
        """
        s = self.stages
        last_term: Array = self._spectrum[-1] / (4.0 * (2.0 * s - 1.0) * (2.0 * s + 1.0))
        return last_term

    @cached_property
    def _spectrum(self) -> Array:
        """Matrix (s, s) from the stages' values to coefficients of Legendre's polynomials."""
        at_nodes = legendre.legvander(2.0 * self.nodes - 1.0, self.stages - 1)
        return np.asarray(np.linalg.inv(at_nodes), dtype=float)

    def values(self, time: Array) -> Array:
        """Matrix (n, s) from the stages' values to those of their polynomial at n times."""
        values: Array = legendre.legvander(2.0 * time - 1.0, self.stages - 1) @ self._spectrum
        return values

    def displacements(self, time: Array) -> Array:
        """Matrix (n, s) from accelerations at the stages to displacements at n times.

        The velocities at the stages are interpolated in between: a polynomial that fitted the
        accelerations themselves would not be a stable method.
        """
        displacements: Array = self._integral(time) @ self.first
        return displacements

    def _integral(self, time: Array) -> Array:
        """Matrix (n, s) from the stages' values to their polynomial's integrals from time 0."""
        series = legendre.legint(np.eye(self.stages), lbnd=-1.0, scl=0.5)
        values: Array = legendre.legvander(2.0 * time - 1.0, self.stages) @ series @ self._spectrum
        return values
