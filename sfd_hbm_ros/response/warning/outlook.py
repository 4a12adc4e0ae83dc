"""What lies ahead of a machine: the jumps at both ends of its present stretch of a branch."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from sfd_hbm_ros.response.curves.jumps import Direction

SLIGHT = 0.01
"""Change of the eccentricity below which a jump is none for an operator, of the clearance."""


class Change(NamedTuple):
    """What a jump does to one damper: its eccentricity before and after, NaN if unknown."""

    damper: str
    before: float
    after: float


def changes(before: Mapping[str, float], after: Mapping[str, float]) -> tuple[Change, ...]:
    """What becomes of the eccentricities of the dampers, the greatest change first.

    Where it is not known what comes after, it is the greatest eccentricity before.
    """
    found = [Change(name, one, after.get(name, math.nan)) for name, one in before.items()]
    return tuple(sorted(found, key=_size, reverse=True))


def _size(change: Change) -> float:
    size = abs(change.after - change.before)
    return change.before if math.isnan(size) else size


@dataclass(frozen=True)
class JumpAhead:
    """Where a machine would leave its branch if its speed changed in one direction.

    Attributes
    ----------
    direction : Direction
        The direction.
    speed : float
        Speed of the jump [rad/s]; infinite for none ahead, NaN for not computable (REP 117).
    eccentricity_before, eccentricity_after : float
        Greatest eccentricity of any damper on both sides of the jump; NaN without a jump, and
        after it where no stable response is known to land on.
    changes : tuple of Change
        What it does to each damper, the greatest change first; empty where that is not known.
    reach : float
        Speed up or down to which it is known that there is none [rad/s]; NaN with a jump.
    """

    direction: Direction
    speed: float
    eccentricity_before: float = math.nan
    eccentricity_after: float = math.nan
    changes: tuple[Change, ...] = ()
    reach: float = math.nan

    @property
    def upwards(self) -> bool:
        """Whether the orbit grows."""
        return self.leading.after > self.leading.before

    @property
    def leading(self) -> Change:
        """The damper to speak of; without a name where there is none."""
        unnamed = Change("", self.eccentricity_before, self.eccentricity_after)
        return self.changes[0] if self.changes else unnamed

    def margin(self, speed: float) -> float:
        """Distance from a speed to that of the jump [rad/s]; 0 where it has been passed."""
        if not math.isfinite(self.speed):
            return self.speed
        ahead = self.speed - speed
        return max(0.0, ahead if self.direction is Direction.RUN_UP else -ahead)


@dataclass(frozen=True)
class Outlook:
    """What lies ahead of a machine.

    Attributes
    ----------
    speed : float
        Its speed [rad/s].
    acceleration : float
        Its angular acceleration [rad/s2], negative for a coast-down; NaN if unknown.
    bistable : bool or None
        Whether another stable response is known at this speed; None for not computable.
    run_up, coast_down : JumpAhead
        Where it would leave its branch on the way up, and on the way down.
    settled : bool
        Whether the acceleration has settled, so that it tells a time.
    eccentricity : float
        Greatest eccentricity of any damper there, as the curve has it; NaN if unknown.
    others : tuple of Outlook
        What lies ahead if the machine is on another response at this speed, where it is not known
        on which; no jump of theirs is nearer.
    """

    speed: float
    acceleration: float
    bistable: bool | None
    run_up: JumpAhead
    coast_down: JumpAhead
    settled: bool = True
    eccentricity: float = math.nan
    others: tuple["Outlook", ...] = ()

    @property
    def next(self) -> JumpAhead:
        """The jump in the direction of travel; at a steady or unknown one the nearer of both."""
        if self.acceleration > 0.0:
            return self.run_up
        if self.acceleration < 0.0:
            return self.coast_down
        return min(self.run_up, self.coast_down, key=self._remoteness)

    @property
    def remoteness(self) -> tuple[int, float]:
        """Order of outlooks by their next jumps, the nearest first."""
        return self._remoteness(self.next)

    @property
    def margin(self) -> float:
        """Distance to the next jump [rad/s]; infinite for none, NaN for not computable."""
        return self.next.margin(self.speed)

    @property
    def relative_margin(self) -> float:
        """The margin over the speed."""
        return self.margin / self.speed

    @property
    def time_to_jump(self) -> float:
        """Time to the next jump at the present acceleration [s]; infinite at a steady speed.

        It is not known until the acceleration has settled, after a start or a reversal.
        """
        moving = self.acceleration != 0.0 and math.isfinite(self.margin)
        return math.nan if moving and not self.settled else self.rough_time_to_jump

    @property
    def rough_time_to_jump(self) -> float:
        """The same [s], whether or not the acceleration has settled."""
        margin = self.margin
        if not math.isfinite(margin):
            return margin
        return margin / abs(self.acceleration) if self.acceleration != 0.0 else math.inf

    def _remoteness(self, jump: JumpAhead) -> tuple[int, float]:
        """Order of jumps: a known one by its margin, then one not computable, then none."""
        margin = jump.margin(self.speed)
        if math.isnan(margin):
            return 1, 0.0
        return (0, margin) if math.isfinite(margin) else (2, 0.0)


def unknown_outlook(speed: float, acceleration: float) -> Outlook:
    """The outlook while there is no curve, or none that holds, or the branch is unknown."""
    run_up, coast_down = (JumpAhead(direction, math.nan) for direction in Direction)
    return Outlook(speed, acceleration, None, run_up, coast_down)
