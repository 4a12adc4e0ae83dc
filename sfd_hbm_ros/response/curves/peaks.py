"""Peaks of the vibration along a response curve, located as events on its branches.

A peak is where the vibration, the orbit without its mean, is greatest along the arc of a branch
that is stable there. It is sought with the branch's own equations between two points, and so
does not depend on where the points of the branch lie or on the range that was followed.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

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
_SMOOTH = 0.001  # of the vibration, by which a cubic may err in the middle of a step

Measure = Callable[[Response], Array]


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


@one_blas_thread
def damper_peaks(curve: ResponseCurve) -> list[Peak]:
    """Peaks of the vibration of every damper's journal, in rising order of the parameter."""
    return _peaks(curve, curve.dampers, lambda _, response: vibrations_of_dampers(response))


@one_blas_thread
def disk_peaks(curve: ResponseCurve) -> list[Peak]:
    """Peaks of the vibration of every disk over the speed, in rising order of it.

    Where another entry than the speed varies there are none.
    """
    if isinstance(curve.family, ParameterFamily):
        return []
    names = tuple(disk.name for disk in curve.balance.machine.disks)
    return _peaks(curve, names, vibrations_of_disks)


def vibrations_of_dampers(response: Response) -> Array:
    """Vibration of every damper's journal [m], zero to peak, (dampers,)."""
    return np.array([vibration(response, name) for name in response.journals])


def vibrations_of_disks(branch: CurveBranch, response: Response) -> Array:
    """Vibration of every disk of a response on a branch over the speed [m], (disks,).

    They are NaN where a harmonic meets a resonance of the shaft with its journals held.
    """
    balance = branch.family.at(response.speed).balance
    try:
        return np.array([*disk_vibrations(balance, response).values()])
    except ResonanceError:
        return np.full(len(balance.machine.disks), np.nan)


def _peaks(
    curve: ResponseCurve,
    names: Sequence[str],
    measure: Callable[[CurveBranch, Response], Array],
) -> list[Peak]:
    found: list[Peak] = []
    for branch in curve.branches:
        if len(branch.values) > 1 and names:
            arc = _Arc(branch, partial(measure, branch))
            for column, name in enumerate(names):
                found += _peaks_on(arc, name, column)
    return sorted(found, key=lambda peak: peak.value)


def _peaks_on(arc: "_Arc", name: str, column: int) -> Iterator[Peak]:
    """Peaks of one column of an arc's heights."""
    nodes = arc.nodes
    heights = np.array([node.heights[column] for node in nodes])
    for step in _steps_with_a_maximum(heights):
        before, after = nodes[step : step + 2]
        flat = _FLAT * max(heights[step : step + 2]) / arc.length(before, after)
        if not (
            before.stable_after and before.slopes[column] > flat and after.slopes[column] < -flat
        ):
            continue
        top = locate(arc.path, before.point, after.point, lambda at: arc.slopes(at)[column])
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
                side = locate(arc.path, *ends, lambda at: arc.heights(at)[column] - level)
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
            _Node(
                self,
                measure(response),
                kind is None,
                None in branch.instability[i : i + 2],
                index=i,
            )
            for i, (response, kind) in enumerate(
                zip(branch.solutions, branch.instability, strict=True)
            )
        ]
        self.nodes: list[_Node] = [known[0]]
        for before, after in pairwise(known):
            self.nodes += [*self._between(before, after, _HALVINGS), after]

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
        return self._measure(with_unknowns(self.branch.solutions[0], speed, x))

    def _between(self, before: "_Node", after: "_Node", halvings: int) -> "list[_Node]":
        """Nodes between two others, as many as show how the measures go there."""
        values = before.value, after.value
        if not halvings or abs(values[1] - values[0]) <= _LONG * max(map(abs, values)):
            return []
        length = self.length(before, after)
        point = self.path.corrector.corrected(before.point, 0.5 * length, [after.point])
        if point is None:
            return []
        middle = _Node(self, self.heights(point), before.stable_after, before.stable_after, point)
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

    Attributes
    ----------
    heights : (k,) array
        The measures.
    stable, stable_after : bool
        Whether it is stable, and the step from it to the next.
    """

    def __init__(
        self,
        arc: _Arc,
        heights: Array,
        stable: bool,
        stable_after: bool,
        point: Point | None = None,
        index: int = 0,
    ) -> None:
        self._arc, self._point, self._index = arc, point, index
        self.heights, self.stable, self.stable_after = heights, stable, stable_after

    @property
    def value(self) -> float:
        """The parameter."""
        return self._point.value if self._point else float(self._arc.branch.values[self._index])

    @cached_property
    def point(self) -> Point:
        """The point with its tangent."""
        return self._point or self._arc.known(self._index)

    @cached_property
    def slopes(self) -> Array:
        """Derivatives of the measures along the arc, (k,)."""
        return self._arc.slopes(self.point)
