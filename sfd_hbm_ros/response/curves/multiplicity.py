"""How many stable responses a machine has at a speed, and whether it stays on the upper one."""

from itertools import pairwise

import numpy as np

from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import first_place, landings, legs, span
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.curves.place import Place, places_at, response_on
from sfd_hbm_ros.response.responses import SAME, Response, distance

_SEEN = 0.01  # of the clearance, a difference that is more than a matter of rounding


def stable_responses(curve: ResponseCurve, value: float) -> list[Response]:
    """All different stable responses that a curve shows at a value of its parameter.

    Parameters
    ----------
    curve : ResponseCurve
        The curve; its detached branches count too.
    value : float
        The parameter: for a speed [rad/s].

    Returns
    -------
    list of Solution or QuasiPeriodicResponse
        Converged responses, in rising order of their greatest eccentricity.
    """
    found: list[Response] = []
    for place in places_at(curve.every_branch, value):
        response = response_on(place) if place.stable else None
        if response and all(distance(response, other) > SAME for other in found):
            found.append(response)
    return sorted(found, key=lambda one: one.eccentricity_max)


def several_stable(curve: ResponseCurve) -> list[tuple[float, float]]:
    """Ranges of the parameter in which a curve shows more than one stable response.

    They lie between folds, ends of branches and points at which stability changes.
    """
    ends: set[float] = set()
    for branch in curve.every_branch:
        changes = np.flatnonzero(branch.stable[1:] != branch.stable[:-1])
        ends |= set(branch.values[[0, -1, *changes, *np.flatnonzero(branch.fold)]].tolist())
    ranges: list[tuple[float, float]] = []
    for low, high in pairwise(sorted(ends)):
        if len(_different(curve, 0.5 * (low + high))) < 2:
            continue
        if ranges and ranges[-1][1] == low:
            low = ranges.pop()[0]
        ranges.append((low, high))
    return ranges


def locked_up(curve: ResponseCurve) -> bool:
    """Whether a machine that runs up through the range is on an upper response at its end.

    Its film has locked up: there is a lower stable response, onto which it never came down.
    """
    *_, last = legs(curve, first_place(curve.branches, rising=True), Direction.RUN_UP.end)
    end, (_, highest) = last.end, span(curve.every_branch)
    lower = (other.eccentricity for other in landings(curve.every_branch, end))
    return end.value == highest and min(lower, default=np.inf) < end.eccentricity - _SEEN


def _different(curve: ResponseCurve, value: float) -> list[Place]:
    """Places of different stable responses, told apart without a solve."""
    found: list[Place] = []
    for place in places_at(curve.every_branch, value):
        if place.stable and all(place.distance(one.response) > _SEEN for one in found):
            found.append(place)
    return found
