"""What came during a run, and how its way up and its way down compare. Without ROS."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.node.joining import Joining
from sfd_hbm_ros.node.speed_profile import RPM

Array = NDArray[np.float64]

PARTS = frozenset({"speed", "eccentricity", "harmonics"})
"""The topics that belong together."""

_NOTHING: Mapping[str, Any] = MappingProxyType({})
_BRIDGED = 3.0  # times the usual distance of two speeds: over more nothing is interpolated
_LIMIT = 100_000  # predictions kept, so that a monitor left alone does not fill the memory


@dataclass(frozen=True)
class DamperPoint:
    """What was predicted for one damper.

    Attributes
    ----------
    eccentricity_max, eccentricity_mean : float
        Over one orbit; NaN where there is no solution.
    amplitudes : tuple of float
        Amplitudes of x from 1x on, zero to peak [m].
    """

    eccentricity_max: float
    eccentricity_mean: float
    amplitudes: tuple[float, ...]


@dataclass(frozen=True)
class RunPoint:
    """A speed and what was predicted at it.

    Attributes
    ----------
    time : float
        Since the first speed [s].
    rpm : float
        Rotor speed [rpm].
    dampers : mapping of str to DamperPoint
        By the damper's name; empty where nothing was predicted.
    """

    time: float
    rpm: float
    dampers: Mapping[str, DamperPoint] = field(default_factory=dict)

    @property
    def solved(self) -> bool:
        """Whether there is a solution."""
        return all(np.isfinite(d.eccentricity_max) for d in self.dampers.values())


class RunRecord:
    """The predictions of a run in the order of their arrival.

    A speed above the one before it belongs to the way up, one below it to the way down.

    Attributes
    ----------
    points : deque of RunPoint
        The last 100 000 predictions.
    speeds : int
        How many speeds came.
    news : RunPoint or None
        The newest prediction, or the newest speed if none is newer; for the reader to clear.
    """

    def __init__(self) -> None:
        self.points: deque[RunPoint] = deque(maxlen=_LIMIT)
        self.speeds = 0
        self.news: RunPoint | None = None
        self._joining = Joining(PARTS)
        self._begin = 0

    def take(self, stamp: int, part: str, value: Any) -> None:
        """Take what came on one of the topics in `PARTS` with a stamp [ns].

        The value is a speed [rad/s], greatest and mean eccentricities by damper, or amplitudes
        [m] by damper.
        """
        if part == "speed":
            self._begin = self._begin if self.speeds else stamp
            self.speeds += 1
            if self.news is None or not self.news.dampers:
                self.news = self._point(stamp, value)
        parts = self._joining.add(stamp, part, value)
        if parts is not None:
            self.news = self._point(stamp, **parts)
            self.points.append(self.news)

    def _point(
        self,
        stamp: int,
        speed: float,
        eccentricity: Mapping[str, tuple[float, float]] = _NOTHING,
        harmonics: Mapping[str, Sequence[float]] = _NOTHING,
    ) -> RunPoint:
        """Return a speed and what was predicted at it."""
        dampers = {
            name: DamperPoint(greatest, mean, tuple(harmonics.get(name, ())))
            for name, (greatest, mean) in eccentricity.items()
        }
        return RunPoint((stamp - self._begin) * 1e-9, speed / RPM, dampers)

    @property
    def dampers(self) -> list[str]:
        """Names of the dampers."""
        return list(self.points[-1].dampers) if self.points else []

    def way(self, damper: str, direction: int) -> Array:
        """Return speeds [rpm] and greatest eccentricities of the way up (1) or down (-1), (n, 2).

        In the order of the speeds; those without a solution are left out.
        """
        return np.array(sorted(self._moving(damper, direction))).reshape(-1, 2)

    def largest_difference(self, damper: str) -> tuple[float, float] | None:
        """Return the largest difference of the eccentricity between up and down, and its speed.

        The way down is interpolated to the speeds of the way up, but not where predictions are
        missing. None where there is nothing to compare.
        """
        up, down = self.way(damper, 1), self.way(damper, -1)
        right = np.searchsorted(down[:, 0], up[:, 0])
        inside = (right > 0) & (right < len(down))
        up, right = up[inside], right[inside]
        gaps = np.diff(down[:, 0])
        up = up[gaps[right - 1] <= _BRIDGED * np.median(gaps)] if up.size else up
        if not up.size:
            return None
        differences = np.abs(up[:, 1] - np.interp(up[:, 0], *down.T))
        largest = int(np.argmax(differences))
        return float(differences[largest]), float(up[largest, 0])

    def _moving(self, damper: str, direction: int) -> Iterator[tuple[float, float]]:
        """Yield speed and eccentricity where the speed has just changed in a direction."""
        for before, point in pairwise(self.points):
            moved = (point.rpm - before.rpm) * direction > 0.0
            if moved and point.solved and damper in point.dampers:
                yield point.rpm, point.dampers[damper].eccentricity_max
