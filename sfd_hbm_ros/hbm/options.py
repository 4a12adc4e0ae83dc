"""Settings of Newton's method and of the continuation."""

from dataclasses import dataclass


class OptionError(ValueError):
    """A setting out of its range: the sentence has its name, its value and what is allowed."""


@dataclass(frozen=True)
class NewtonOptions:
    """Settings of Newton's method.

    Parameters
    ----------
    tolerance : float
        Norm of the residual, relative to the load, below which the forces balance.
    iterations : int
        Largest number of linear systems to solve.
    shortest_step : float
        Part of Newton's step below which it is given up.

    Raises
    ------
    OptionError
        If a setting is out of its range.
    """

    tolerance: float = 1e-10
    iterations: int = 40
    shortest_step: float = 1e-4

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance < 1.0:
            raise OptionError(f"tolerance: {self.tolerance} is not allowed, it must be in (0, 1)")
        if self.iterations < 1:
            raise OptionError(
                f"iterations: {self.iterations} is not allowed, it must be at least 1"
            )
        if not 0.0 < self.shortest_step < 1.0:
            raise OptionError(
                f"shortest_step: {self.shortest_step} is not allowed, it must be in (0, 1)"
            )


DEFAULTS = NewtonOptions()


@dataclass(frozen=True)
class ContinuationOptions:
    """Settings of the continuation; lengths of the arc are in clearances.

    Parameters
    ----------
    first_step, longest_step, shortest_step : float
        Lengths of the arc.
    turning : float
        Largest angle between the tangents of neighbouring points [rad].
    iterations : int
        Corrector steps that a point may take.
    eccentricity : float
        Eccentricity at which the branch ends, below 1.
    points : int
        Largest number of steps, those that are taken again among them.
    arc : float
        Greatest length of the arc: the parameter's whole range counts as 1.
    progress : float
        Length of the arc that a hundred steps have to make. One that makes less creeps up to
        something that it will never reach.

    Raises
    ------
    OptionError
        If a setting is out of its range.
    """

    first_step: float = 0.01
    longest_step: float = 0.06
    shortest_step: float = 1e-7
    turning: float = 0.3
    iterations: int = 6
    eccentricity: float = 0.9999
    points: int = 5_000
    arc: float = 200.0
    progress: float = 1e-4

    def __post_init__(self) -> None:
        if not 0.0 < self.shortest_step <= self.first_step <= self.longest_step:
            raise OptionError(
                f"steps: {self.shortest_step}, {self.first_step}, {self.longest_step} are not "
                "allowed, they must be positive and rise from shortest over first to longest"
            )
        if not 0.0 < self.eccentricity < 1.0:
            raise OptionError(
                f"eccentricity: {self.eccentricity} is not allowed, it must be between 0 and 1"
            )
        for name in ("points", "arc", "progress"):
            if not getattr(self, name) > 0:
                value = getattr(self, name)
                raise ValueError(f"{name}: {value} is not allowed, it must be above 0")
