"""The jumps that a machine has made: noticed, counted, and kept until they are acknowledged."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated, Any

from sfd_hbm_ros.machine.parts import Part, plain, read
from sfd_hbm_ros.machine.rules import REQUIRED, number, title
from sfd_hbm_ros.response.tracking.tracked import BranchName, Tracked
from sfd_hbm_ros.response.warning.outlook import SLIGHT, Outlook, changes
from sfd_hbm_ros.units import RPM

_KEPT = 10  # jumps, the last ones
_SEVERAL = {BranchName.UPPER, BranchName.MIDDLE, BranchName.LOWER}
_NEAR = 0.005  # part of the speed, between two operating points of which an orbit settles one


@dataclass(frozen=True)
class MadeJump(Part):
    """A jump that a machine made.

    Raises
    ------
    MachineError
        If a value is not allowed.
    """

    damper: Annotated[str, title("the damper whose eccentricity changed most", default=REQUIRED)]
    speed: Annotated[float, number("the speed at which it happened", "rad/s", above=0.0)]
    before: Annotated[float, number("its eccentricity before", "of the clearance", least=0.0)]
    after: Annotated[float, number("its eccentricity after", "of the clearance", least=0.0)]
    time: Annotated[
        float,
        number("time of the first prediction after it, since 1970", "s", least=0.0, below=1e11),
    ]

    def __str__(self) -> str:
        way = "up" if self.after > self.before else "down"
        change = f"{self.before:.2f} to {self.after:.2f}"
        return f"{self.damper} jumped {way} at {self.speed / RPM:.0f} rpm, {change}"

    def told(self, now: float) -> str:
        """Return what happened and when, by the local clock; the day unless it is that of now."""
        when, today = (datetime.fromtimestamp(time) for time in (self.time, now))
        day = "" if when.date() == today.date() else f" on {when:%Y-%m-%d}"
        return f"{self}, at {when:%H:%M:%S}{day}"

    @property
    def row(self) -> str:
        """What happened, for programs: the time by UTC first."""
        when = datetime.fromtimestamp(self.time, UTC)
        return f"{when:%Y-%m-%dT%H:%M:%S}Z {self}"


class JumpLog:
    """Notices the jumps among predictions that follow one another.

    Attributes
    ----------
    last : deque of MadeJump
        The last ten.
    count : int
        How many there were.
    unseen : int
        How many of them are to be acknowledged yet.
    """

    def __init__(self) -> None:
        self.last: deque[MadeJump] = deque(maxlen=_KEPT)
        self.count = 0
        self.unseen = 0
        self._before: Tracked | None = None  # the last that is believed
        self._pending: MadeJump | None = None  # on the way to a speed that may have been wrong

    def take(self, tracked: Tracked, time: float, ahead: Outlook | None = None) -> None:
        """Take the next operating point.

        Parameters
        ----------
        tracked : Tracked
            The operating point.
        time : float
            When it was, since 1970 [s].
        ahead : Outlook, optional
            What lay ahead of the last one.
        """
        jump = self._pending or self._jump(tracked, time, ahead)
        if tracked.doubtful:
            self._pending = jump
            return
        self._pending, self._before = None, tracked
        if jump and not tracked.wrong_before:
            self.last.append(jump)
            self.count += 1
            self.unseen += 1

    def lose_sight(self) -> None:
        """Note that what the machine does until the next operating point is not seen."""
        self._before = self._pending = None

    def acknowledge(self) -> bool:
        """Note that an operator has seen them; return whether there was one to be seen."""
        seen, self.unseen = self.unseen > 0, 0
        return seen

    def sentence(self, now: float) -> str:
        """Return what is to be acknowledged of jumps, at a time [s]; empty for nothing."""
        if not (self.unseen and self.last):
            return ""
        told = self.last[-1].told(now)
        return f"{told}. " if self.unseen == 1 else f"{told}, the last of {self.unseen} jumps. "

    @property
    def rows(self) -> Iterable[str]:
        """The last jumps for programs, the newest first."""
        return (jump.row for jump in reversed(self.last))

    def to_dict(self) -> dict[str, Any]:
        """Plain data from which the log can be restored after a restart."""
        last = [plain(jump) for jump in self.last]
        return {"count": self.count, "unseen": self.unseen, "last": last}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> JumpLog:
        """The log as it was when the data were made; a new one of those that are empty.

        Raises
        ------
        MachineError, TypeError, ValueError
            If the data are not those of a log.
        """
        log = cls()
        if not data:
            return log
        log.count, log.unseen = int(data["count"]), int(data["unseen"])
        log.last.extend(read(MadeJump, jump, "jumps.last") for jump in list(data["last"])[-_KEPT:])
        if not len(log.last) <= log.count >= log.unseen >= 0:
            raise ValueError("the numbers of jumps do not go together")
        return log

    def _jump(self, tracked: Tracked, time: float, ahead: Outlook | None) -> MadeJump | None:
        """The jump on the way from the last operating point, if there was one to be seen."""
        before = self._before
        if before is None or not (tracked.jumped or _thrown(before, tracked)):
            return None
        if before.branch is BranchName.UNKNOWN and before.current:
            return None  # it was assumed to be where it jumped from
        [worst, *_] = changes(_eccentricities(before), _eccentricities(tracked))
        if abs(worst.after - worst.before) < SLIGHT:
            return None
        way = before.solution.speed, tracked.solution.speed
        return MadeJump(worst.damper, _passed(ahead, way), worst.before, worst.after, time)


def _thrown(before: Tracked, after: Tracked) -> bool:
    """Whether the machine is found on what was the other stable response, as an orbit settles."""
    names = before.branch, after.branch
    moved = abs(after.solution.speed - before.solution.speed)
    if (
        not _SEVERAL.issuperset(names)
        or before.other is None
        or moved > _NEAR * before.solution.speed
    ):
        return False
    here, there, now = (
        one.eccentricity_max for one in (before.solution, before.other, after.solution)
    )
    return before.branch is not after.branch and abs(now - there) < abs(now - here)


def _passed(ahead: Outlook | None, way: tuple[float, float]) -> float:
    """Speed of the jump that was expected on the way between two speeds, or the last of these."""
    for jump in (ahead.run_up, ahead.coast_down) if ahead else ():
        if math.isfinite(jump.speed) and min(way) <= jump.speed <= max(way):
            return jump.speed
    return way[1]


def _eccentricities(tracked: Tracked) -> dict[str, float]:
    journals = tracked.solution.journals
    return {name: journal.eccentricity_max for name, journal in journals.items()}
