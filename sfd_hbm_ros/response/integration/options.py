"""Settings of the time integration."""

from dataclasses import dataclass

from sfd_hbm_ros.hbm.options import OptionError

SAMPLES = 128
"""Positions handed on in each revolution, a multiple of the steps."""


@dataclass(frozen=True)
class IntegrationOptions:
    """Settings of the integration.

    Parameters
    ----------
    steps : int
        Steps in a revolution, before any is halved; a divisor of `SAMPLES`.
    stages : int
        Stages of Radau's method in a step, at least 2.
    tolerance : float
        Norm of the imbalance, relative to that of the accelerations, at which a step is solved.
    resolution : float
        Part of the clearance that the last term of a step's motion may have; otherwise it is
        halved.

    Raises
    ------
    OptionError
        If a setting is out of its range.
    """

    steps: int = 2
    stages: int = 12
    tolerance: float = 1e-6
    resolution: float = 2e-6

    def __post_init__(self) -> None:
        if self.steps < 1 or SAMPLES % self.steps:
            raise OptionError(f"steps: {self.steps} is not allowed, it must divide {SAMPLES}")
        if not self.resolution > 0.0:
            raise OptionError(f"resolution: {self.resolution} is not allowed, it must be positive")


DEFAULTS = IntegrationOptions()
