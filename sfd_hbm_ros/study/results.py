"""The outcomes of a whole study, and what they say of the jumps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.study.design import Design
from sfd_hbm_ros.study.task import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Results:
    """The outcomes of a study.

    Parameters
    ----------
    design : Design
        Its variants.
    outcomes : sequence of Outcome
        What became of each.
    """

    design: Design
    outcomes: Sequence[Outcome]

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Whether each variant has a solution, (variants,)."""
        return np.array([outcome.peak_speed is not None for outcome in self.outcomes])

    def jump_speeds(self, direction: Direction) -> Array:
        """Speeds of the first jumps of those variants that jump [rad/s], rising."""
        speeds = [getattr(outcome, direction.value) for outcome in self.outcomes]
        return np.sort(np.array([speed for speed in speeds if speed is not None], dtype=float))

    def jumped(self, direction: Direction) -> tuple[Array, Array]:
        """Steps of the share of variants that have jumped by the time they come to a speed.

        Parameters
        ----------
        direction : Direction
            Whether the speed rises or falls on the way.

        Returns
        -------
        (n,) array
            Speeds at which variants jump, in the order of the way [rad/s].
        (n,) array
            The share from each on, of the variants that have a solution.
        """
        speeds = self.jump_speeds(direction)
        if direction is Direction.COAST_DOWN:
            speeds = speeds[::-1]
        return speeds, np.arange(1.0, len(speeds) + 1.0) / max(1, self.solved.sum())
