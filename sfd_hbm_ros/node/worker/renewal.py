"""When to compute anew what changes make outdated. Without ROS."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

QUIET = 0.5
"""Time without a change [s] after which to compute."""

LONGEST = 5.0
"""Time after the first change [s] from which on no further one is waited for or interrupts."""


@dataclass
class Renewal:
    """Waits for the last of several changes, but not for ever where they never end.

    Times are those of a steady clock [s].
    """

    _waiting: bool = False
    _first: float = math.inf  # change that no finished computation holds
    _last: float = -math.inf

    def change(self, now: float, first: bool = False) -> None:
        """Note a change; the first computation of all need not wait for another."""
        self._waiting = True
        self._first, self._last = min(self._first, now), -math.inf if first else now

    def due(self, now: float, busy: bool) -> bool:
        """Return whether to compute now, which is to be done then.

        A computation may be interrupted for a newer one, but is left to finish where that has
        been wanted for long: else steady changes would never let any finish.
        """
        if not self._waiting:
            if not busy:
                self._first = math.inf
            return False
        long = now - self._first >= LONGEST
        if busy if long else now - self._last < QUIET:
            return False
        self._waiting = False
        return True


@dataclass
class MeanLoads:
    """The mean of the loads [N] that arrived at stations; a load that rests is itself the mean."""

    _count: int = 0
    _sums: dict[str, tuple[float, float]] = field(default_factory=dict)

    def add(self, forces: Mapping[str, tuple[float, float]]) -> None:
        """Note the forces (x, y) that act at the stations."""
        if forces.keys() != self._sums.keys():
            self._count, self._sums = 0, {}
        self._count += 1
        for station, (x, y) in forces.items():
            before = self._sums.get(station, (0.0, 0.0))
            self._sums[station] = before[0] + x, before[1] + y

    def forces(self, latest: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Return the mean at every station, or what acts there now where none was noted."""
        means = {name: (x / self._count, y / self._count) for name, (x, y) in self._sums.items()}
        return {**latest, **means}
