"""What lies ahead of a machine: the jumps at both ends of its present stretch of a branch."""

import math
from dataclasses import dataclass

from sfd_hbm_ros.response.curves.jumps import Direction


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
    """

    direction: Direction
    speed: float
    eccentricity_before: float = math.nan
    eccentricity_after: float = math.nan

    @property
    def upwards(self) -> bool:
        """Whether the orbit grows."""
        return self.eccentricity_after > self.eccentricity_before

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
    """

    speed: float
    acceleration: float
    bistable: bool | None
    run_up: JumpAhead
    coast_down: JumpAhead

    @property
    def next(self) -> JumpAhead:
        """The jump in the direction of travel; at a steady or unknown one the nearer of both."""
        if self.acceleration > 0.0:
            return self.run_up
        if self.acceleration < 0.0:
            return self.coast_down
        return min(self.run_up, self.coast_down, key=self._remoteness)

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
        """Time to the next jump at the present acceleration [s]; infinite at a steady speed."""
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
