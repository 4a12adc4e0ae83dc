"""What came during a run, and how its way up and its way down compare. Without ROS."""

import math
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.node.monitor.joining import Joining
from sfd_hbm_ros.node.monitor.run_point import DamperPoint, RunPoint
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]

PARTS = frozenset({"speed", "eccentricity", "harmonics"})
"""The topics that belong together."""

_NOTHING: Mapping[str, Any] = MappingProxyType({})
_BRIDGED = 3.0  # times the usual distance of two speeds: over more nothing is interpolated
_UNPAIRED = 100  # measured orbits kept until the prediction at their speed comes
_LIMIT = 100_000  # predictions kept, so that a monitor left alone does not fill the memory


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
        The newest prediction beside which there is a measured orbit, or the newest, or else the
        newest speed; for the reader to clear.
    """

    def __init__(self) -> None:
        self.points: deque[RunPoint] = deque(maxlen=_LIMIT)
        self.speeds = 0
        self.news: RunPoint | None = None
        self._joining = Joining(PARTS)
        self._measured: dict[int, Mapping[str, Sequence[float]]] = {}
        self._begin = 0

    def take(self, stamp: int, part: str, value: Any) -> RunPoint | None:
        """Take what came on one of the topics in `PARTS` with a stamp [ns].

        The value is a speed [rad/s], eccentricities by damper, the greatest and that on the other
        branch, or amplitudes [m] by damper.

        Returns
        -------
        The prediction, if this completes it.
        """
        if part == "speed":
            self._begin = self._begin if self.speeds else stamp
            self.speeds += 1
            if self.news is None or not self.news.dampers:
                self.news = self._point(stamp, value)
        parts = self._joining.add(stamp, part, value)
        if parts is None:
            return None
        point = self._point(stamp, **parts, measured=self._measured.pop(stamp, _NOTHING))
        self.points.append(point)
        if self.news is None or point.measured or not self.news.measured:
            self.news = point
        return point

    def measure(self, stamp: int, amplitudes: Mapping[str, Sequence[float]]) -> None:
        """Take the measured amplitudes [m] by damper, before the prediction with their stamp."""
        self._measured[stamp] = amplitudes
        if len(self._measured) > _UNPAIRED:
            del self._measured[next(iter(self._measured))]

    def _point(
        self,
        stamp: int,
        speed: float,
        eccentricity: Mapping[str, tuple[float, float]] = _NOTHING,
        harmonics: Mapping[str, Sequence[float]] = _NOTHING,
        measured: Mapping[str, Sequence[float]] = _NOTHING,
    ) -> RunPoint:
        """Return a speed and what was predicted and measured at it."""
        dampers = {
            name: DamperPoint(*both, tuple(harmonics.get(name, ())), tuple(measured.get(name, ())))
            for name, both in eccentricity.items()
        }
        return RunPoint(stamp, (stamp - self._begin) * 1e-9, speed / RPM, dampers)

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

    def disagreements(self, damper: str) -> Array:
        """Return how far measured orbits were from those predicted, see `DamperPoint`, (n,)."""
        found = (p.dampers[damper].disagreement for p in self.points if damper in p.dampers)
        return np.array([one for one in found if math.isfinite(one)])

    def _moving(self, damper: str, direction: int) -> Iterator[tuple[float, float]]:
        """Yield speed and eccentricity where the speed has just changed in a direction."""
        for before, point in pairwise(self.points):
            moved = (point.rpm - before.rpm) * direction > 0.0
            if moved and point.solved and damper in point.dampers:
                yield point.rpm, point.dampers[damper].eccentricity_max
