"""Speeds that leap away and are back at once: they were measured wrongly.

A missed or doubled pulse of the keyphasor halves or doubles a speed, which the rotor's inertia
does not allow. The machine was never there, and did not jump on the way.
"""

import math
from dataclasses import dataclass
from typing import Generic, TypeVar

Known = TypeVar("Known")

LEAP = 0.4
"""Part of the greater of two successive speeds by which they differ where one may be wrong."""

RETURN = 0.5
"""Time [s] within which the speed is back then; a machine that is stepped by hand takes longer."""


@dataclass
class Excursion(Generic[Known]):
    """What was known of a machine before its speed leapt, until it is back or stays away."""

    _speed: float = math.nan  # the last before the leap, else the newest
    _time: float = math.nan
    _known: Known | None = None  # None where the last speed is no leap away

    @property
    def away(self) -> bool:
        """Whether the last speed leapt away from one that may come back."""
        return self._known is not None

    def returned(self, speed: float, time: float, known: Known) -> Known | None:
        """Take the next speed, and return what was known before a leap that it ends.

        Parameters
        ----------
        speed : float
            The speed [rad/s].
        time : float
            When it was measured [s]; NaN if that is not known, and then it ends no leap.
        known : object
            What is known of the machine up to this speed.
        """
        near = abs(speed - self._speed) < LEAP * max(abs(speed), abs(self._speed))
        in_time = abs(time - self._time) <= RETURN
        before = self._known
        if in_time and not near:
            self._known = known if before is None else before  # the first leap's, of several
            return None
        self._speed, self._time, self._known = speed, time, None
        return before if in_time else None
