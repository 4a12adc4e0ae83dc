"""The way of a machine along its response curve, with the jumps on it, and no solve.

The machine stays on its branch until that turns back, or ends within the range because the
journal closes on its clearance; there it jumps to the other stable response that is nearest in
eccentricity. Where its branch loses stability to one that leaves it, the machine moves onto that
one if it is stable and leads onward; otherwise it jumps there too.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.place import Place, place_on, places_at
from sfd_hbm_ros.response.responses import SAME

_MOST_LEGS = 20  # of one journey, so that a curve with an odd end cannot make it endless


class Leg(NamedTuple):
    """A part of a journey without a jump.

    Attributes
    ----------
    end : Place
        Its last place.
    arrived : bool
        Whether that is the end of the journey.
    landing : Place or None
        Where the machine jumps to from its end; None at the end of the journey, where it leaves
        the curve's range, or the curve shows no other stable response where a branch ends.
    """

    end: Place
    arrived: bool
    landing: Place | None


class Journey(NamedTuple):
    """Where a journey along a curve ends.

    Attributes
    ----------
    place : Place or None
        The place; None where the journey leaves the curve's range, or the curve shows no other
        stable response where a branch ends.
    jumps : int
        Jumps on the way.
    """

    place: Place | None
    jumps: int


def first_place(branches: Sequence[CurveBranch], rising: bool = True) -> Place:
    """Where a journey up or down through the whole range begins, a stable place if any is."""
    sign = 1.0 if rising else -1.0
    ends = [
        Place(branch, index, float(branch.values[point]))
        for branch in branches
        for index, point in ((0, 0), (len(branch.values) - 2, -1))
    ]
    return min(ends, key=lambda end: (sign * end.value, not end.stable))


def span(branches: Sequence[CurveBranch]) -> tuple[float, float]:
    """Lowest and highest value of the parameter on some branches."""
    lowest = min(float(branch.values.min()) for branch in branches)
    highest = max(float(branch.values.max()) for branch in branches)
    return lowest, highest


def travel(curve: ResponseCurve, place: Place, value: float) -> Journey:
    """Let the parameter go steadily from a place to another value, as it goes in a machine."""
    *before, last = legs(curve, place, value)
    return Journey(last.end if last.arrived else None, len(before))


def legs(curve: ResponseCurve, place: Place, value: float) -> Iterator[Leg]:
    """The parts of a journey from a place to another value, with a jump from each to the next."""
    lowest, highest = span(curve.branches)
    for _ in range(_MOST_LEGS):
        end, arrived = _along(curve, place, value)
        within = not arrived and lowest < end.value < highest
        landing = next(iter(landings(curve.branches, end)), None) if within else None
        yield Leg(end, arrived, landing)
        if landing is None:
            return
        place = landing


def landings(branches: Sequence[CurveBranch], left: Place) -> list[Place]:
    """Other stable places at the value of a branch's point, the nearest in eccentricity first."""
    others = [
        place
        for place in places_at(branches, left.value)
        if place.stable
        and not (place.branch is left.branch and abs(place.index - left.index) <= 1)
        and place.distance(left.nearest) > SAME  # where branches meet they are one response
    ]
    return sorted(others, key=lambda place: abs(place.eccentricity - left.eccentricity))


def _along(curve: ResponseCurve, place: Place, value: float) -> tuple[Place, bool]:
    """The place of a value that is reached without a jump, or else where the jump happens.

    Returns
    -------
    The place, and whether it is that of the value.
    """
    sign = 1.0 if value > place.value else -1.0
    branch, index = place.branch, place.index
    for _ in range(sum(len(one.values) for one in curve.branches)):  # no stretch is met twice
        ends = branch.values[index : index + 2].tolist()
        if min(ends) <= value <= max(ends):
            return place_on(branch, index, value), True
        ahead = bool(sign * (ends[1] - ends[0]) > 0.0)
        onward = _onward(curve, branch, index, ahead, sign)
        if onward is None:
            return Place(branch, index, ends[1] if ahead else ends[0]), False
        branch, index = onward
    return Place(branch, index, ends[1] if ahead else ends[0]), False


def _onward(
    curve: ResponseCurve, branch: CurveBranch, index: int, ahead: bool, sign: float
) -> tuple[CurveBranch, int] | None:
    """The next stretch between two points: where branches meet, a stable one."""
    point = index + ahead
    meeting = curve.meeting(branch, point)
    ways = [(branch, index + (1 if ahead else -1))]
    for other, at in meeting:
        ways += [(other, at), (other, at - 1)]
    value = float(branch.values[point])
    for way, at in ways:
        stretches = len(way.values) - 1
        if way.stop is Stop.CLOSED:
            at %= stretches
        if not 0 <= at < stretches:
            continue
        ends = way.values[at : at + 2].tolist()
        leads = sign * (sum(ends) - 2.0 * value) >= 0.0
        if leads and (not meeting or Place(way, at, value).stable):
            return way, at
    return None
