"""The parts of a response curve: from both ends of its range, and from where it has gaps.

A branch that begins at one end of the range mostly leads to the other. Where it does not, as the
orbit closes on the clearance or there is no solution to begin with, the other end is tried, and
then values between: those that no part spans, and those at which a part ends. What two parts share
is one branch.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import MachineFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress, judged
from sfd_hbm_ros.response.curves.place import solutions_at
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.responses import SAME, Response, distance

_SHARES = (0.5, 0.25, 0.75, 0.1, 0.9)  # of a gap, at which a solution is looked for in it
_MOST_PROBES = 12  # values in all at which one is looked for, which takes long where there is none
_BESIDE = 1e-3  # of the range, from the end of a part to where it is looked for beyond it
_NARROW = 1e-3  # of the range, below which a gap is none
_EXPECTED = Stop.RANGE, Stop.CLOSED, Stop.JOINED


@dataclass(frozen=True)
class Gap:
    """A part of the range in which no response was found.

    Attributes
    ----------
    low, high : float
        Its ends.
    reason : str
        Why a branch that comes to it ends there; empty if none does.
    """

    low: float
    high: float
    reason: str


def follow_parts(
    family: MachineFamily,
    start: float,
    end: float,
    branch_from: Callable[[float, float], Branch],
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> list[CurveBranch]:
    """Follow the branches over a range from both of its ends and from between.

    Parameters
    ----------
    family : SpeedFamily or ParameterFamily
        The machine as the parameter varies.
    start, end : float
        The ends of the range.
    branch_from : callable
        Returns the branch that begins at one end of the range, towards another.
    options : ContinuationOptions, optional
        Settings of the continuation from between.
    progress : callable, optional
        Called with the parameter of every new point.

    Returns
    -------
    list of CurveBranch
        The branch that begins at `start` first, if there is one.

    Raises
    ------
    NoSolutionError
        If no solution was found anywhere, with what was said at the start of the range.
    """
    failures: list[NoSolutionError] = []
    parts: list[CurveBranch] = []
    for begin, onward in ((start, end), (end, start)):
        try:
            part = judged(branch_from(begin, onward), progress)
        except NoSolutionError as error:
            failures.append(error)
            continue
        parts = _with_part(parts, part)
        if part.stop is Stop.RANGE and part.values[-1] == onward:
            break
    bounds = min(start, end), max(start, end)
    tried: set[float] = set()
    while len(tried) < _MOST_PROBES:
        value = next((at for at in _unknown(parts, bounds) if at not in tried), None)
        if value is None:
            break
        tried.add(value)
        equations = family.at(value)
        found = solve(equations.balance, equations.speed)
        if found.converged and not lies_on(parts, value, found):
            parts = _with_part(parts, both_ways(family, found, value, bounds, options, progress))
    if not parts:
        raise NoSolutionError(f"{failures[0]}; nor at the other end of the range or between")
    turned = [part.reversed if part.values[-1] == start else part for part in parts]
    return sorted(turned, key=lambda part: bool(part.values[0] != start))


def gaps(parts: Sequence[CurveBranch], bounds: tuple[float, float]) -> tuple[Gap, ...]:
    """Parts of a range, given by its lower and its upper end, that no branch spans."""
    spans = sorted((float(part.values.min()), float(part.values.max())) for part in parts)
    least, reached = _NARROW * (bounds[1] - bounds[0]), bounds[0]
    found = []
    for low, high in [*spans, (bounds[1], bounds[1])]:
        if low - reached > least:
            found.append(Gap(reached, low, _reason(parts, (reached, low))))
        reached = max(reached, high)
    return tuple(found)


def _reason(parts: Sequence[CurveBranch], sides: tuple[float, float]) -> str:
    """Why a branch ends at one side of a gap."""
    for part in parts:
        for stop, value in ((part.begin, part.values[0]), (part.stop, part.values[-1])):
            if stop not in _EXPECTED and value in sides:
                return stop.value
    return ""


def lies_on(branches: Sequence[CurveBranch], value: float, response: Response) -> bool:
    """Whether a response at a value of the parameter lies on one of the branches."""
    return any(_index_on(branch, value, response) is not None for branch in branches)


def both_ways(
    family: MachineFamily,
    response: Response,
    value: float,
    bounds: tuple[float, float],
    options: ContinuationOptions | None = None,
    progress: Progress | None = None,
) -> CurveBranch:
    """The branch through a response, closed or followed to both ends of it in the range."""
    x, (low, high) = response.unknowns, bounds
    if value in bounds:
        other = high if value == low else low
        return judged(Branch(family, x, value, other, bounds, options), progress)
    ahead = judged(Branch(family, x, value, high, bounds, options), progress)
    if ahead.stop is Stop.CLOSED:
        return ahead
    behind = judged(Branch(family, x, value, low, bounds, options), progress)
    # the response itself belongs to both
    return behind.reversed.joined_to(ahead, 1)


def _unknown(parts: Sequence[CurveBranch], bounds: tuple[float, float]) -> Iterator[float]:
    """Values at which there may be responses that no part has."""
    for gap in gaps(parts, bounds):
        yield from (gap.low + share * (gap.high - gap.low) for share in _SHARES)
    for part in parts:
        for one in (part, part.reversed):
            if one.stop not in _EXPECTED and len(one.values) > 1:
                ahead = np.sign(one.values[-1] - one.values[-2])
                beyond = float(one.values[-1] + ahead * _BESIDE * (bounds[1] - bounds[0]))
                if bounds[0] < beyond < bounds[1]:
                    yield beyond


def _with_part(parts: Sequence[CurveBranch], part: CurveBranch) -> list[CurveBranch]:
    """The parts with another one, which is joined to those that it shares something with."""
    apart = []
    for other in parts:
        joined = _joined(other, part)
        if joined is None:
            apart.append(other)
        else:
            part = joined
    return [*apart, part]


def _joined(one: CurveBranch, other: CurveBranch) -> CurveBranch | None:
    """Two parts as one branch, if an end of either lies on the other."""
    for first, second in (
        (one, other),
        (one.reversed, other),
        (other, one),
        (other.reversed, one),
    ):
        if first.stop in _EXPECTED:
            continue
        index = _index_on(second, float(first.values[-1]), first.solutions[-1])
        if index is None:
            continue
        if _ahead(first, len(first.values) - 2) @ _ahead(second, index) > 0.0:
            return first.joined_to(second, index + 1)
        back = second.reversed
        return first.joined_to(back, len(back.values) - 1 - index)
    return None


def _index_on(branch: CurveBranch, value: float, response: Response) -> int | None:
    """Index of the point of a branch before a response, if that lies on it."""
    for index, other in solutions_at(branch, value):
        if distance(other, response) < SAME:
            return index
    return None


def _ahead(branch: CurveBranch, index: int) -> NDArray[np.float64]:
    """The way from a point of a branch to the next one, relative to the greatest values."""
    one, other = branch.solutions[index : index + 2]
    scale = np.abs(branch.values).max()
    move = (other.unknowns - one.unknowns) / np.abs(one.unknowns).max()
    return np.append(move, (branch.values[index + 1] - branch.values[index]) / scale)
