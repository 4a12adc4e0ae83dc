"""One moment of a run: a speed, what was predicted at it and what was measured. Without ROS."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class DamperPoint:
    """What was predicted for one damper, and measured.

    Attributes
    ----------
    eccentricity_max : float
        Over one orbit; NaN where there is no solution.
    eccentricity_other : float
        The same on the other stable branch; NaN where there is none.
    amplitudes : tuple of float
        Amplitudes of x from 1x on, zero to peak [m].
    measured : tuple of float
        The same as measured; empty where nothing was.
    """

    eccentricity_max: float
    eccentricity_other: float
    amplitudes: tuple[float, ...]
    measured: tuple[float, ...] = ()

    @property
    def disagreement(self) -> float:
        """Difference of the measured amplitude of 1x and the predicted, over the greater one."""
        if not (self.measured and self.amplitudes):
            return math.nan
        predicted, measured = self.amplitudes[0], self.measured[0]
        return abs(measured - predicted) / max(measured, predicted)


@dataclass(frozen=True)
class RunPoint:
    """A speed and what was predicted at it.

    Attributes
    ----------
    stamp : int
        Of the speed [ns].
    time : float
        Since the first speed [s].
    rpm : float
        Rotor speed [rpm].
    dampers : mapping of str to DamperPoint
        By the damper's name; empty where nothing was predicted.
    """

    stamp: int
    time: float
    rpm: float
    dampers: Mapping[str, DamperPoint] = field(default_factory=dict)

    @property
    def solved(self) -> bool:
        """Whether there is a solution."""
        return all(math.isfinite(d.eccentricity_max) for d in self.dampers.values())

    @property
    def eccentricity_max(self) -> float:
        """Greatest eccentricity of any damper; NaN where nothing was predicted."""
        return max((d.eccentricity_max for d in self.dampers.values()), default=math.nan)

    @property
    def measured(self) -> bool:
        """Whether anything was measured."""
        return any(d.measured for d in self.dampers.values())
