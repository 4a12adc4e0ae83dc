"""Peaks of the vibration along a response curve, located as events on its branches.

A peak is where the vibration, the orbit without its mean, is greatest along the arc of a branch
that is stable there. It is sought with the branch's own equations between two points, and so
does not depend on where the points of the branch lie or on the range that was followed.
"""

import contextlib
import copy
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.events import locate
from sfd_hbm_ros.hbm.family import ParameterFamily
from sfd_hbm_ros.hbm.points import Point
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import span
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.responses import (
    Response,
    disk_vibrations,
    response_at,
    vibration,
    with_unknowns,
)
from sfd_hbm_ros.rotor import ResonanceError
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_SHIFT = 1e-4  # along the arc, over which the vibration is differenced
_FLAT = 1e-7  # slope of the vibration, of itself over a step of the arc, that is taken to be none
_LONG = 0.01  # of the parameter, a step in which a peak and a dip might hide
_HALVINGS = 6  # of a long step at most
_ACCURACY = 1e-6  # of a step of the arc
_SMOOTH = 0.001  # of the vibration, by which a cubic may err in the middle of a step

Measure = Callable[[float, Response], Array]

LOCKED_UP = 0.995
"""Eccentricity beyond which the film is all but locked, if no peak lies there."""


class DiskVibration(NamedTuple):
    """The greatest vibration of any disk at a point of a curve.

    Attributes
    ----------
    disk : str
        Its name.
    vibration : float
        Greatest distance from its mean position [m], zero to peak.
    value : float
        The parameter: for a speed [rad/s].
    response : Solution or QuasiPeriodicResponse
        The response.
    """

    disk: str
    vibration: float
    value: float
    response: Response


@dataclass(frozen=True, eq=False)
class Peak:
    """A peak of the vibration of a damper's journal or of a disk.

    Attributes
    ----------
    of : str
        Name of the damper or the disk.
    value : float
        The parameter: for a speed [rad/s].
    vibration : float
        Greatest distance from the mean position [m], zero to peak.
    response : Solution or QuasiPeriodicResponse
        The response there.
    amplification_factor : float or None
        Of this vibration: peak speed over the width of the peak at 1/sqrt(2) of its vibration
        (API 684). None where another entry than the speed varies, or where a fold, a loss of
        stability or an end of the branch leaves the width undefined.
    """

    of: str
    value: float
    vibration: float
    response: Response
    amplification_factor: float | None


class CurveVibrations:
    """The vibrations along a response curve, and their peaks.

    Parameters
    ----------
    curve : ResponseCurve
        The curve. Its detached branches are left aside.
    """

    def __init__(self, curve: ResponseCurve) -> None:
        self._curve = curve

    @cached_property
    @one_blas_thread
    def damper_peaks(self) -> list[Peak]:
        """Peaks of every damper's journal, in rising order of the parameter."""
        return _peaks(self._damper_arcs, self._curve.dampers)

    @cached_property
    @one_blas_thread
    def disk_peaks(self) -> list[Peak]:
        """Peaks of every disk over the speed, in rising order of it.

        Where another entry than the speed varies there are none.
        """
        if isinstance(self._curve.family, ParameterFamily):
            return []
        return _peaks(self._disk_arcs, [disk.name for disk in self._curve.balance.machine.disks])

    @one_blas_thread
    def greatest_of_disks(self) -> DiskVibration | None:
        """The greatest stable vibration of any disk, at the known points and at the peaks.

        Points beyond `LOCKED_UP` that are no peak are left out: on a branch that ends on the
        clearance the rotor nears a resonance with its journals held, and the number grows without
        bound. None where the machine has no disk or no response is stable.
        """
        found = [
            DiskVibration(peak.of, peak.vibration, peak.value, peak.response)
            for peak in self.disk_peaks
        ]
        for arc in self._disk_arcs:
            for node in arc.nodes:
                below = node.response.eccentricity_max < LOCKED_UP
                if node.stable and below and np.isfinite(node.heights).any():
                    column = int(np.nanargmax(node.heights))
                    disk = self._curve.balance.machine.disks[column].name
                    height = float(node.heights[column])
                    found.append(DiskVibration(disk, height, node.value, node.response))
        return max(found, key=lambda one: one.vibration, default=None)

    @cached_property
    def _damper_arcs(self) -> "list[_Arc]":
        return [
            _Arc(branch, _vibrations_of_dampers)
            for branch in self._curve.branches
            if len(branch.values) > 1
        ]

    @cached_property
    def _disk_arcs(self) -> "list[_Arc]":
        """The same points: to recover the motion of the whole rotor takes its time."""
        return [
            arc.measuring(partial(_vibrations_of_disks, arc.branch)) for arc in self._damper_arcs
        ]


def greatest_of_disks(
    balance: HarmonicBalance, value: float, response: Response
) -> DiskVibration | None:
    """The greatest vibration of any disk in a response of a machine.

    None where it has no disk or a harmonic meets an undamped resonance of its shaft.
    """
    try:
        vibrations = disk_vibrations(balance, response)
    except ResonanceError:
        return None
    disk = max(vibrations, key=lambda name: vibrations[name], default=None)
    return None if disk is None else DiskVibration(disk, vibrations[disk], value, response)


def _vibrations_of_dampers(_: float, response: Response) -> Array:
    """Vibration of every damper's journal [m], zero to peak, (dampers,)."""
    return np.array([vibration(response, name) for name in response.journals])


def _vibrations_of_disks(branch: CurveBranch, value: float, response: Response) -> Array:
    """Vibration of every disk [m], (disks,); NaN at a resonance with the journals held."""
    balance = branch.family.at(value).balance
    try:
        return np.array([*disk_vibrations(balance, response).values()])
    except ResonanceError:
        return np.full(len(balance.machine.disks), np.nan)


def _peaks(arcs: "list[_Arc]", names: Sequence[str]) -> list[Peak]:
    found = [
        peak
        for arc in arcs
        for column, name in enumerate(names)
        for peak in _peaks_on(arc, name, column)
    ]
    return sorted(found, key=lambda peak: peak.value)


def _peaks_on(arc: "_Arc", name: str, column: int) -> Iterator[Peak]:
    """Peaks of one column of an arc's heights."""
    heights = np.array([node.heights[column] for node in arc.nodes])
    for step in _steps_with_a_maximum(heights):
        # where branches meet the arc has no tangent
        with contextlib.suppress(np.linalg.LinAlgError):
            yield from _peaks_in(arc, heights, name, column, step)


def _peaks_in(arc: "_Arc", heights: Array, name: str, column: int, step: int) -> Iterator[Peak]:
    """The peak between a node and the next, if the measure rises at one and falls at the other."""
    before, after = arc.nodes[step : step + 2]
    flat = _FLAT * max(heights[step : step + 2]) / arc.length(before, after)
    rises = before.slopes[column] > flat and after.slopes[column] < -flat
    if not (before.stable_after and rises):
        return
    top = locate(arc.path, before.point, after.point, lambda at: arc.slopes(at)[column], _ACCURACY)
    if top is not None:
        height = float(arc.heights(top)[column])
        factor = _amplification_factor(arc, heights, column, step, top)
        yield Peak(name, float(top.value), height, arc.response(top), factor)


def _steps_with_a_maximum(heights: Array) -> list[int]:
    """Steps beside the nodes that are higher than their neighbours, by the node before each.

    The ends of a branch count among these: the maximum may lie just within.
    """
    last = len(heights) - 1
    padded = np.concatenate([[-np.inf], heights, [-np.inf]])
    highest = np.flatnonzero((heights >= padded[:-2]) & (heights >= padded[2:]))
    steps = {step for node in highest.tolist() for step in (node - 1, node)}
    return sorted(step for step in steps if 0 <= step < last)


def _amplification_factor(
    arc: "_Arc", heights: Array, column: int, step: int, top: Point
) -> float | None:
    """Peak speed over the width of the peak that lies in a step."""
    if isinstance(arc.branch.family, ParameterFamily):
        return None
    level = arc.heights(top)[column] / np.sqrt(2.0)
    sides = []
    for way in (range(step, -1, -1), range(step + 1, len(heights))):
        nearer = top
        for i in way:
            node = arc.nodes[i]
            if heights[i] < level:
                ends = (nearer, node.point) if way.step > 0 else (node.point, nearer)
                side = locate(
                    arc.path, *ends, lambda at: arc.heights(at)[column] - level, _ACCURACY
                )
                sides += [] if side is None else [side.value]
                break
            if not node.stable:
                break
            nearer = node.point
    if len(sides) < 2:
        return None
    return float(top.value / abs(sides[1] - sides[0]))


class _Arc:
    """A branch with some measures of its responses, and points between the known ones.

    Attributes
    ----------
    branch : CurveBranch
        The branch, of two points or more.
    path : Branch
        What corrects points of it.
    nodes : list of _Node
        Its points, and in long steps as many between as show how the measures go.
    """

    def __init__(self, branch: CurveBranch, measure: Measure) -> None:
        self.branch, self._measure = branch, measure
        start, (low, high) = float(branch.values[0]), span([branch])
        end = max(low, high, key=lambda one: abs(one - start))
        self.path = Branch(branch.family, branch.solutions[0].unknowns, start, end, (low, high))
        known = [
            _Node(self, kind is None, None in branch.instability[i : i + 2], i)
            for i, kind in enumerate(branch.instability)
        ]
        self.nodes: list[_Node] = [known[0]]
        for before, after in pairwise(known):
            self.nodes += [*self._between(before, after, _HALVINGS), after]

    def measuring(self, measure: Measure) -> "_Arc":
        """The same points with another measure."""
        other = copy.copy(self)
        other._measure = measure
        other.nodes = [node.on(other) for node in self.nodes]
        return other

    def measured(self, value: float, response: Response) -> Array:
        """The measures of a response."""
        return self._measure(value, response)

    def length(self, before: "_Node", after: "_Node") -> float:
        """Distance of two neighbours along the arc."""
        return self.path.corrector.distance(before.point, after.point)

    def known(self, index: int) -> Point:
        """One of the branch's own points, with its tangent along the arc."""
        behind = min(index, len(self.branch.values) - 2)
        ahead = self._scaled(behind + 1) - self._scaled(behind)
        return self.path.corrector.known(
            self.branch.solutions[index].unknowns,
            float(self.branch.values[index]),
            ahead / np.linalg.norm(ahead),
        )

    def response(self, point: Point) -> Response:
        """The response at a point."""
        return response_at(self.branch.family.at(point.value), point.x)

    def heights(self, point: Point) -> Array:
        """The measures at a point."""
        return self._heights(point.value, point.x)

    def slopes(self, point: Point) -> Array:
        """Derivatives of the measures along the arc."""
        shift = _SHIFT * point.tangent * self.path.corrector.scale
        ahead, behind = (
            self._heights(point.value + sign * shift[-1], point.x + sign * shift[:-1])
            for sign in (1.0, -1.0)
        )
        return (ahead - behind) / (2.0 * _SHIFT)

    def _heights(self, value: float, x: Array) -> Array:
        """The measures of unknowns, whether or not they solve the equations."""
        speed = None if isinstance(self.branch.family, ParameterFamily) else value
        return self._measure(value, with_unknowns(self.branch.solutions[0], speed, x))

    def _between(self, before: "_Node", after: "_Node", halvings: int) -> "list[_Node]":
        """Nodes between two others, as many as show how the measures go there."""
        values = before.value, after.value
        if not halvings or abs(values[1] - values[0]) <= _LONG * max(map(abs, values)):
            return []
        try:
            length = self.length(before, after)
            point = self.path.corrector.corrected(before.point, 0.5 * length, [after.point])
        except np.linalg.LinAlgError:  # where branches meet the arc has no tangent
            point = None
        if point is None:
            return []
        middle = _Node(self, before.stable_after, before.stable_after, point)
        # the cubic that has the heights and the slopes of both ends
        cubic = 0.5 * (before.heights + after.heights)
        cubic = cubic + 0.125 * length * (before.slopes - after.slopes)
        if np.all(abs(middle.heights - cubic) <= _SMOOTH * abs(cubic)):
            return [middle]
        return [
            *self._between(before, middle, halvings - 1),
            middle,
            *self._between(middle, after, halvings - 1),
        ]

    def _scaled(self, index: int) -> Array:
        unknowns = np.append(self.branch.solutions[index].unknowns, self.branch.values[index])
        scaled: Array = unknowns / self.path.corrector.scale
        return scaled


class _Node:
    """A point of an arc with its measures; what takes time is computed when it is asked for.

    Parameters
    ----------
    arc : _Arc
        The arc.
    stable, stable_after : bool
        Whether it is stable, and the step from it to the next.
    place : Point or int
        The point itself, or the index of one of the branch's own.
    """

    def __init__(self, arc: _Arc, stable: bool, stable_after: bool, place: Point | int) -> None:
        self._arc, self._place = arc, place
        self.stable, self.stable_after = stable, stable_after

    def on(self, arc: _Arc) -> "_Node":
        """The same point, on an arc of other measures."""
        place = self.__dict__.get("point", self._place)
        node = _Node(arc, self.stable, self.stable_after, place)
        node.__dict__["response"] = self.response
        return node

    @property
    def value(self) -> float:
        """The parameter."""
        if isinstance(self._place, Point):
            return self._place.value
        return float(self._arc.branch.values[self._place])

    @cached_property
    def response(self) -> Response:
        """The response."""
        if isinstance(self._place, Point):
            return self._arc.response(self._place)
        return self._arc.branch.solutions[self._place]

    @cached_property
    def point(self) -> Point:
        """The point with its tangent."""
        return self._place if isinstance(self._place, Point) else self._arc.known(self._place)

    @cached_property
    def heights(self) -> Array:
        """The measures, (k,)."""
        return self._arc.measured(self.value, self.response)

    @cached_property
    def slopes(self) -> Array:
        """Derivatives of the measures along the arc, (k,)."""
        return self._arc.slopes(self.point)
