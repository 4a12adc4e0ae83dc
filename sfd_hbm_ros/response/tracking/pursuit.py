"""The next operating point: along the current curve, or without one along its own branch."""

from sfd_hbm_ros.hbm import HarmonicBalance
from sfd_hbm_ros.hbm.time_limit import TimeLimitError, time_limit
from sfd_hbm_ros.response.tracking.following import Followed, follow, holds
from sfd_hbm_ros.response.tracking.guide import Guide
from sfd_hbm_ros.response.tracking.operating_point import OperatingPoint, landed, placed
from sfd_hbm_ros.response.tracking.way import Way


def travelled(guide: Guide, last: OperatingPoint, speed: float) -> OperatingPoint | None:
    """Go to a speed [rad/s] along the current curve, if there is one that leads there."""
    if last.place is None or last.balance is not guide.balance:
        return None
    place, jumps = guide.journey(last.place, speed)
    solution = guide.solved(place, last.place, last.solution) if place else None
    if not (place and solution):
        return None
    return OperatingPoint(guide.balance, solution, place, jumps > 0, place.stable_orbit)


def pursued(guide: Guide, last: OperatingPoint, speed: float, patience: float) -> OperatingPoint:
    """Follow a machine to a speed and to what it has become meanwhile, or to where it jumps.

    Parameters
    ----------
    guide : Guide
        The machine as it is now.
    last : OperatingPoint
        Where it was, and what it was then.
    speed : float
        The speed [rad/s].
    patience : float
        Processor time that following it may take [s]; where that is not enough, it is sought
        where a machine lands that jumps.
    """
    try:
        with time_limit(patience):
            solution, part, orientation = _followed(guide, last, speed)
    except TimeLimitError:
        solution, part, orientation = Followed(None, 0.0, None)
    if solution and part == 1.0:
        point = placed(guide, solution, orientation)
        if point.place or not guide.current or holds(point.balance, solution):
            return point
    return landed(guide, solution or last.solution, speed)


def _followed(guide: Guide, last: OperatingPoint, speed: float) -> Followed:
    """How far the response can be followed."""
    old, harmonics = last.solution, guide.balance.harmonics
    if old.harmonics.revolutions > harmonics.revolutions:
        harmonics = old.harmonics
    end = guide.balance_for(harmonics)
    x = harmonics.change_from(old.harmonics, old.coefficients)
    if x.shape[1] != end.clearances.size:
        return Followed(None, 0.0, None)
    start = end
    if last.balance is not guide.balance:
        start = last.balance
        if start.harmonics != harmonics:
            start = HarmonicBalance(start.machine, harmonics, start.model)
    return follow(Way(start, old.speed, end, speed), x.ravel(), last.orientation)
