"""What an engineer reads off a response curve: folds, jumps, peaks, amplification.

Folds and jumps that are too small to see, in the eccentricity or in the speed, are read apart from
the others: neither a measurement nor an operator could tell them from none.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.hbm.family import ParameterFamily
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import Leg, legs
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.jumps import Direction, Jump, jump_of, leaps, leaps_from
from sfd_hbm_ros.response.curves.peaks import (
    CurveVibrations,
    DiskVibration,
    Peak,
    greatest_of_disks,
)
from sfd_hbm_ros.response.responses import Response, vibration
from sfd_hbm_ros.units import RPM

_SMALL_CHANGE = 0.01  # of the clearance, in every damper: a jump that nobody sees
_NARROW = 0.1 * RPM  # a hysteresis that nobody sees [rad/s]
_OF_A_JUMP = 2.0 / 3.0  # the distance of two folds, as both vanish: f(x) = x^3 - a x


@dataclass(frozen=True)
class Mark:
    """A point of a curve, and the damper that is of interest there.

    Attributes
    ----------
    value : float
        The parameter: for a speed [rad/s].
    eccentricity : float
        Greatest eccentricity of the damper.
    damper : str
        Its name.
    response : Solution, QuasiPeriodicResponse or None
        The response; None where there is none, and the numbers are NaN.
    """

    value: float
    eccentricity: float
    damper: str = ""
    response: Response | None = None

    @property
    def vibration(self) -> float:
        """Vibration of the damper's journal [m], zero to peak."""
        return np.nan if self.response is None else vibration(self.response, self.damper)


class Detached(NamedTuple):
    """What is read off a detached branch."""

    branch: CurveBranch
    folds: list[Mark]
    jumps: list[Jump]


@dataclass(frozen=True, eq=False)
class Summary:
    """Readings of a response curve.

    Attributes
    ----------
    curve : ResponseCurve
        The curve.
    """

    curve: ResponseCurve

    @property
    def folds(self) -> list[Mark]:
        """Where a branch turns back, branch by branch in the order of the arc."""
        return [fold for fold, tiny in self._folds if not tiny]

    @property
    def tiny_folds(self) -> list[Mark]:
        """Folds that are too small to see."""
        return [fold for fold, tiny in self._folds if tiny]

    @property
    def jumps(self) -> list[Jump]:
        """Jumps of a journey up through the range, then of one down."""
        return [jump for jump, tiny in self._jumps if not tiny]

    @property
    def tiny_jumps(self) -> list[Jump]:
        """Jumps that are too small to see."""
        return [jump for jump, tiny in self._jumps if tiny]

    @cached_property
    def detached(self) -> list[Detached]:
        """Folds of each detached branch, and the jumps of a machine that is on it."""
        return [
            Detached(
                branch,
                [self._worst(branch, i) for i in np.flatnonzero(branch.fold).tolist()],
                [
                    jump_of(leap, direction)
                    for direction in Direction
                    for leap in leaps_from(self.curve, branch, direction)
                ],
            )
            for branch in self.curve.detached
        ]

    @cached_property
    def instabilities(self) -> list[tuple[Instability, Mark]]:
        """Where a branch loses stability other than at a fold, along its arc or against it."""
        return [
            (kind, self._worst(branch, i))
            for branch in self.curve.branches
            for i, kind in branch.onsets
        ]

    @property
    def anywhere_stable(self) -> bool:
        """Whether the curve shows a response that a machine can stay on."""
        return any(branch.stable.any() for branch in self.curve.branches)

    @property
    def peaks(self) -> list[Peak]:
        """Peaks of the vibration of every damper's journal, in rising order of the parameter."""
        return self._vibrations.damper_peaks

    @property
    def disk_peaks(self) -> list[Peak]:
        """Peaks of the vibration of every disk, in rising order of the speed."""
        return self._vibrations.disk_peaks

    @cached_property
    def highest_peak(self) -> Peak | None:
        """The peak of the greatest vibration of any damper's journal, of its clearance."""
        return max(
            self.peaks,
            key=lambda peak: peak.vibration / peak.response.journals[peak.of].clearance,
            default=None,
        )

    @cached_property
    def peak(self) -> Mark:
        """Where the vibration of any damper's journal is greatest, of its clearance.

        That is the highest peak, or the last response before a jump that lets the vibration fall
        where that is greater. Where there is neither it is the greatest stable vibration at all,
        at an end of the range, and NaN where no response is stable. The eccentricity is that of
        the same damper.
        """
        marks = [_mark(peak.value, peak.response, peak.of) for peak in self.peaks]
        marks += [
            _mark(jump.value, jump.before, name)
            for jump in self.jumps
            for name in self.curve.dampers
            if vibration(jump.before, name) > vibration(jump.after, name)
        ]
        marks = marks or [
            _mark(value, response, name)
            for value, response in self._stable_points()
            for name in self.curve.dampers
        ]
        return max(marks, key=_of_clearance, default=Mark(np.nan, np.nan))

    @property
    def amplification_factor(self) -> float | None:
        """That of the highest peak; None where there is none or its width is undefined."""
        return self.highest_peak.amplification_factor if self.highest_peak else None

    @cached_property
    def greatest_vibration(self) -> DiskVibration | None:
        """The greatest stable vibration of any disk, on the curve's points, peaks and jumps.

        None where the machine has no disk or no response is stable.
        """
        found = [self._vibrations.greatest_of_disks()]
        found += [self.vibrating(jump.value, jump.before) for jump in self.jumps]
        known = [one for one in found if one is not None]
        return max(known, key=lambda one: one.vibration, default=None)

    def vibrating(self, value: float, response: Response) -> DiskVibration | None:
        """The greatest vibration of any disk in a response of the curve, if it has any."""
        return greatest_of_disks(self.curve.family.at(value).balance, value, response)

    @cached_property
    def _vibrations(self) -> CurveVibrations:
        return CurveVibrations(self.curve)

    @cached_property
    def hysteresis(self) -> float | None:
        """Width of the lowest range that a jump on the way up and one on the way down bound.

        A machine that turned back after either jump would next make the other, so that between
        them there are two stable responses. None where no two jumps belong together so.
        """
        return next((width for _, _, width in self._pairs(self._narrow)), None)

    @cached_property
    def _leaps(self) -> list[tuple[Direction, Leg]]:
        return [(way, leap) for way in Direction for leap in leaps(self.curve, way)]

    @cached_property
    def _jumps(self) -> list[tuple[Jump, bool]]:
        """All jumps, and whether each is too small to see."""
        return [
            (jump_of(leap, direction), _is_tiny(leap, self._narrow))
            for direction, leap in self._leaps
        ]

    @cached_property
    def _folds(self) -> list[tuple[Mark, bool]]:
        """All folds, and whether each is too small to see."""
        left = [
            (leap.end, tiny) for (_, leap), (_, tiny) in zip(self._leaps, self._jumps, strict=True)
        ]
        found = []
        for branch in self.curve.branches:
            folds = np.flatnonzero(branch.fold).tolist()
            near = {i for pair in pairwise(folds) if self._are_near(branch, *pair) for i in pair}
            for i in folds:
                known = [
                    tiny
                    for end, tiny in left
                    if end.branch is branch and end.index in (i - 1, i) and end.point == i
                ]
                found.append((self._worst(branch, i), all(known) if known else i in near))
        return found

    @cached_property
    def _narrow(self) -> list[Leg]:
        """Jumps that bound a hysteresis which is too narrow to see."""
        if isinstance(self.curve.family, ParameterFamily):
            return []
        return [
            leap
            for up, down, width in self._pairs([])
            if abs(width) < _NARROW
            for leap in (up, down)
        ]

    def _pairs(self, unseen: list[Leg]) -> Iterator[tuple[Leg, Leg, float]]:
        """Jumps up and down that belong together, and the width between them."""
        ups, downs = (
            [leap for way, leap in self._leaps if way is one and not _is_tiny(leap, unseen)]
            for one in Direction
        )
        for up in ups:
            for down in downs:
                if self._comes_next(down, up, Direction.COAST_DOWN, unseen) and self._comes_next(
                    up, down, Direction.RUN_UP, unseen
                ):
                    yield up, down, up.end.value - down.end.value

    def _comes_next(self, leap: Leg, before: Leg, way: Direction, unseen: list[Leg]) -> bool:
        """Whether a machine that turns after one jump next makes another that can be seen."""
        assert before.landing is not None
        for following in legs(self.curve, before.landing, way.end):
            if following.landing is None or not _is_tiny(following, unseen):
                return following.end.is_at(leap.end)
        return False

    def _are_near(self, branch: CurveBranch, one: int, other: int) -> bool:
        """Whether two folds are too near each other to be seen."""
        change = _change(branch.solutions[one], branch.solutions[other])
        apart = abs(float(branch.values[one] - branch.values[other]))
        narrow = not isinstance(self.curve.family, ParameterFamily) and apart < _NARROW
        return narrow or change < _OF_A_JUMP * _SMALL_CHANGE

    def _worst(self, branch: CurveBranch, point: int) -> Mark:
        """A point of a branch with the damper of the greatest eccentricity."""
        response = branch.solutions[point]
        motions = response.journals
        worst = max(motions, key=lambda name: motions[name].eccentricity_max)
        return _mark(float(branch.values[point]), response, worst)

    def _stable_points(self) -> Iterator[tuple[float, Response]]:
        for branch in self.curve.branches:
            for value, response, stable in zip(
                branch.values.tolist(), branch.solutions, branch.stable, strict=True
            ):
                if stable:
                    yield value, response


def _mark(value: float, response: Response, damper: str) -> Mark:
    return Mark(value, response.journals[damper].eccentricity_max, damper, response)


def _of_clearance(mark: Mark) -> float:
    assert mark.response is not None
    return mark.vibration / mark.response.journals[mark.damper].clearance


def _is_tiny(leap: Leg, unseen: list[Leg]) -> bool:
    """Whether a jump is too small to see, or one of those that are known not to be seen."""
    assert leap.landing is not None
    return _change(leap.end.nearest, leap.landing.response) < _SMALL_CHANGE or any(
        leap.end.is_at(one.end) for one in unseen
    )


def _change(one: Response, other: Response) -> float:
    """Greatest change of any damper's eccentricity or vibration, of its clearance."""
    changes = [
        abs(first - second)
        for name, motion in one.journals.items()
        for first, second in (
            (motion.eccentricity_max, other.journals[name].eccentricity_max),
            (
                vibration(one, name) / motion.clearance,
                vibration(other, name) / motion.clearance,
            ),
        )
    ]
    return max(changes)
