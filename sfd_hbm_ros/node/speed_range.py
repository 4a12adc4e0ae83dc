"""The range of speeds of the response curve: as configured, or as the machine asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sfd_hbm_ros.units import RPM

LOWEST = 10.0
"""Speed [rad/s] to which the range is widened downwards: what lies below is near rest."""

WIDEST = 3.0
"""Multiple of the highest speed configured up to which the range is widened."""

_ROOM = 1.5  # of a speed, up to which the curve is to tell what lies ahead of it
_AHEAD = 5.0  # s before it would leave the range, at its acceleration, that a speed is followed
_OUTSIDE = 1.0  # s for which it must be so, as a single wrong speed is not followed
_OVERSPEED = 1.25  # multiple of its operating speed at which no machine runs
_CRITICAL = 5.0  # the same of its first critical speed, where no operating speed is given


@dataclass
class SpeedRange:
    """The range of the response curve, which is widened where the machine leaves it.

    Attributes
    ----------
    lowest, highest : float
        The range [rad/s].
    operating : tuple of float
        The operating range that the machine's file gives [rad/s], or empty.
    """

    lowest: float = math.nan
    highest: float = math.nan
    operating: tuple[float, ...] = ()
    _configured: tuple[float, float] = (math.nan, math.nan)
    _inside_at: float = math.inf

    def configure(self, lowest: float, highest: float, operating: tuple[float, ...]) -> None:
        """Begin with a range [rad/s], if it is another one than was configured last."""
        self.operating = operating
        if (lowest, highest) != self._configured:
            self._configured = self.lowest, self.highest = lowest, highest

    def follow(self, speed: float, acceleration: float, now: float) -> bool:
        """Widen the range if a speed [rad/s] is outside, or soon will be; tell whether it was.

        Parameters
        ----------
        speed : float
            The speed, which nobody doubts.
        acceleration : float
            Its acceleration [rad/s2], NaN if unknown.
        now : float
            Time by a steady clock [s].
        """
        rise = _AHEAD * acceleration if math.isfinite(acceleration) else 0.0
        above = max(speed, speed + rise) > self.highest < self._most
        below = min(speed, speed + rise) < self.lowest > LOWEST
        if not (above or below):
            self._inside_at = now
            return False
        self._inside_at = min(self._inside_at, now)
        if now - self._inside_at < _OUTSIDE:
            return False
        if above:
            self.highest = min(max(_ROOM * speed, speed + 2.0 * rise), self._most)
        if below:
            self.lowest = LOWEST
        self._inside_at = now
        return True

    def doubt(self, speed: float, critical: float) -> str:
        """Return why a speed [rad/s] must have been sent in rpm, in words; empty if it may be one.

        Parameters
        ----------
        speed : float
            The speed.
        critical : float
            The machine's first critical speed [rad/s], NaN if unknown.
        """
        lowest, highest = self._configured
        if self.operating:
            limit, what = _OVERSPEED * max(self.operating[1], highest), "operating speed"
            size = self.operating[1]
        elif math.isfinite(critical) and _CRITICAL * critical < self._most:
            limit, what, size = _CRITICAL * critical, "first critical speed", critical
        else:
            limit, what, size = self._most, "highest speed of its curve", highest
        if not (speed > max(limit, highest) and lowest <= speed * RPM <= _ROOM * highest):
            return ""
        return (
            f"{speed:.6g} rad/s are {speed / RPM:.0f} rpm, {speed / size:.1f} times the machine's "
            f"{what}: were {speed:.6g} rpm meant, which are {speed * RPM:.4g} rad/s?"
        )

    @property
    def _most(self) -> float:
        return WIDEST * self._configured[1]


def outside(speed: float, lowest: float, highest: float) -> str:
    """Return on which side of a response curve's range [rad/s] a speed is; empty if it is inside.

    A speed below `LOWEST` counts as inside of a curve that begins there.
    """
    if speed > highest:
        return f"above the response curve, which ends at {highest / RPM:.0f} rpm"
    if speed < lowest and lowest > LOWEST:
        return f"below the response curve, which begins at {lowest / RPM:.0f} rpm"
    return ""
