"""What an engineer reads off a response curve: folds, jumps, peak, amplification."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import Leg, legs
from sfd_hbm_ros.response.curves.jumps import Direction, Jump, jumps, leaps
from sfd_hbm_ros.response.curves.peaks import Peak, damper_peaks
from sfd_hbm_ros.response.responses import Response, vibration


@dataclass(frozen=True)
class Mark:
    """A point of a curve and the eccentricity of a damper there.

    Attributes
    ----------
    value : float
        The parameter: for a speed [rad/s].
    eccentricity : float
        Greatest eccentricity of the damper, or of any if none is named.
    damper : str
        Its name.
    vibration : float
        Its vibration, zero to peak, of the clearance.
    """

    value: float
    eccentricity: float
    damper: str = ""
    vibration: float = np.nan


@dataclass(frozen=True, eq=False)
class Summary:
    """Readings of a response curve.

    Attributes
    ----------
    curve : ResponseCurve
        The curve.
    """

    curve: ResponseCurve

    @cached_property
    def folds(self) -> list[Mark]:
        """Where a branch turns back, branch by branch in the order of the arc."""
        return [
            Mark(float(branch.values[i]), float(branch.worst_eccentricity[i]))
            for branch in self.curve.branches
            for i in np.flatnonzero(branch.fold)
        ]

    @cached_property
    def jumps(self) -> list[Jump]:
        """Jumps of a journey up through the range, then of one down."""
        return [jump for direction in Direction for jump in jumps(self.curve, direction)]

    @cached_property
    def instabilities(self) -> list[tuple[Instability, Mark]]:
        """Where a branch loses stability other than at a fold, along its arc or against it."""
        return [
            (kind, Mark(float(branch.values[i]), float(branch.worst_eccentricity[i])))
            for branch in self.curve.branches
            for i, kind in branch.onsets
        ]

    @cached_property
    def peaks(self) -> list[Peak]:
        """Peaks of the vibration of every damper's journal, in rising order of the parameter."""
        return damper_peaks(self.curve)

    @cached_property
    def highest_peak(self) -> Peak | None:
        """The peak of the greatest vibration of any damper's journal, of its clearance."""
        return max(self.peaks, key=_of_clearance, default=None)

    @cached_property
    def peak(self) -> Mark:
        """Where the vibration of any damper's journal is greatest, of its clearance.

        That is the highest peak, or the last response before a jump that lets the vibration fall
        where that is greater. Where there is neither it is the greatest stable vibration at all,
        at an end of the range, and NaN where no response is stable. The eccentricity is that of
        the same damper.
        """
        marks = [self._marked(peak.response, peak.value, peak.of) for peak in self.peaks]
        marks += [
            self._marked(jump.before, jump.value, name)
            for jump in self.jumps
            for name in self.curve.dampers
            if vibration(jump.before, name) > vibration(jump.after, name)
        ]
        marks = marks or [
            self._marked(response, value, name)
            for branch in self.curve.branches
            for value, response, stable in zip(
                branch.values.tolist(), branch.solutions, branch.stable, strict=True
            )
            for name in self.curve.dampers
            if stable
        ]
        return max(marks, key=lambda mark: mark.vibration, default=Mark(np.nan, np.nan))

    @cached_property
    def hysteresis(self) -> float | None:
        """Width of the lowest range that a jump on the way up and one on the way down bound.

        A machine that turned back after either jump would next make the other, so that between
        them there are two stable responses. None where no two jumps belong together so.
        """
        ups, downs = (leaps(self.curve, direction) for direction in Direction)
        widths = (
            up.end.value - down.end.value
            for up in ups
            for down in downs
            if self._comes_next(down, up, Direction.COAST_DOWN)
            and self._comes_next(up, down, Direction.RUN_UP)
        )
        return next(widths, None)

    def _comes_next(self, leap: Leg, before: Leg, direction: Direction) -> bool:
        """Whether a machine that turns after one jump next makes another."""
        assert before.landing is not None
        following = next(legs(self.curve, before.landing, direction.end))
        return following.end.is_at(leap.end)

    @property
    def amplification_factor(self) -> float | None:
        """That of the highest peak; None where there is none or its width is undefined."""
        return self.highest_peak.amplification_factor if self.highest_peak else None

    def _marked(self, response: Response, value: float, damper: str) -> Mark:
        motion = response.journals[damper]
        part = vibration(response, damper) / motion.clearance
        return Mark(value, motion.eccentricity_max, damper, part)


def _of_clearance(peak: Peak) -> float:
    return peak.vibration / peak.response.journals[peak.of].clearance
