"""The warnings of a run, and the jumps that came of them. Without ROS."""

from __future__ import annotations

import math
import re
from collections import deque
from dataclasses import dataclass

from sfd_hbm_ros.node.monitor.run_point import RunPoint
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.tracking.excursion import Excursion

_LIMIT = 1000  # warnings kept, of which the last few matter
_NUMBER = re.compile(r"\d+(\.\d+)?")


@dataclass(frozen=True)
class JumpWarning:
    """What the predictor says about the next jump.

    Attributes
    ----------
    stamp : int
        When it was said [ns].
    level : int
        That of diagnostic_msgs/DiagnosticStatus.
    sentence : str
        For an operator.
    direction : str
        Direction of the speed in which the next jump comes, as `Direction` has it.
    rpm : float
        Speed of the next jump [rpm]; infinite for none ahead, NaN for not computable.
    seconds : float
        Time to it [s], likewise.
    """

    stamp: int
    level: int
    sentence: str
    direction: str
    rpm: float
    seconds: float

    @property
    def kind(self) -> tuple[int, str]:
        """Level and sentence without its numbers, which change all the time."""
        return self.level, _NUMBER.sub("#", self.sentence)

    def announces(self, other: JumpWarning) -> bool:
        """Return whether it warns of the next jump of another."""
        return self.level > 0 and math.isfinite(self.rpm) and self.direction == other.direction

    def passed(self, before: float, after: float) -> bool:
        """Return whether the jump lies between two speeds [rpm], one after the other."""
        if self.direction == Direction.RUN_UP:
            return before < self.rpm <= after
        return before > self.rpm >= after


@dataclass(frozen=True)
class MetJump:
    """A jump that was expected at a speed which the machine passed.

    Attributes
    ----------
    warning : JumpWarning
        The last word about it.
    before, after : float
        Greatest eccentricity of any damper before and after it.
    ahead : float
        How long before it the warning began [s]; NaN if there was none.
    """

    warning: JumpWarning
    before: float
    after: float
    ahead: float


class WarningRecord:
    """The warnings of a run.

    Attributes
    ----------
    jumps : list of MetJump
        The jumps so far.
    """

    def __init__(self) -> None:
        self.jumps: list[MetJump] = []
        self._warnings: deque[JumpWarning] = deque(maxlen=_LIMIT)
        self._point: RunPoint | None = None
        self._excursion = Excursion[bool]()

    @property
    def newest(self) -> JumpWarning | None:
        """The newest warning."""
        return self._warnings[-1] if self._warnings else None

    def take(self, warning: JumpWarning) -> bool:
        """Take a warning, and return whether it says something new."""
        new = self.newest is None or warning.kind != self.newest.kind
        self._warnings.append(warning)
        return new

    def follow(self, point: RunPoint) -> None:
        """Take a prediction, and note a jump on the way from the one before.

        One at a speed that has just leapt away is left out, as the predictor does.
        """
        self._excursion.returned(point.rpm, point.time, known=True)
        if self._excursion.away:
            return
        before, self._point = self._point, point
        if before is None:
            return
        # A warning is given after the prediction that it bears on, but may come before it.
        earlier = [warning for warning in self._warnings if warning.stamp < point.stamp]
        while earlier:
            if earlier[-1].passed(before.rpm, point.rpm):
                self.jumps.append(_met(earlier, before, point))
                return
            # The newest may already bear on a prediction between both that has not come here.
            if earlier.pop().stamp < before.stamp:
                return


def _met(warnings: list[JumpWarning], before: RunPoint, after: RunPoint) -> MetJump:
    """The jump of the last of some warnings, between two predictions."""
    ahead = math.nan
    for warning in reversed(warnings):
        if not warning.announces(warnings[-1]):
            break
        ahead = (after.stamp - warning.stamp) * 1e-9
    return MetJump(warnings[-1], before.eccentricity_max, after.eccentricity_max, ahead)
