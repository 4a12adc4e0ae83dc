"""When to compute anew what changes make outdated. Without ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass

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
