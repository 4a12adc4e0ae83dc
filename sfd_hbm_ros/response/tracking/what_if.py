"""What a machine would do at another speed, without its going there."""

import numpy as np

from sfd_hbm_ros.response.curves.journey import first_place, travel
from sfd_hbm_ros.response.curves.place import Place
from sfd_hbm_ros.response.tracking.guide import Guide
from sfd_hbm_ros.response.tracking.tracked import Tracked, branch_name, no_solution
from sfd_hbm_ros.rotor import ResonanceError

NO_CURVE = "there is no response curve to travel along"
OUTSIDE = "no journey along the response curve leads there"
NOT_FOUND = "Newton's method does not lead from the response curve to a solution"


def what_if(guide: Guide, place: Place | None, speed: float) -> Tracked:
    """Say what a machine would do if its speed went steadily to another one.

    The journey goes along the curve, current or outdated, and each response is solved by one run
    of Newton's method for the machine as it is. So the work is bounded.

    Parameters
    ----------
    guide : Guide
        The machine and its curve.
    place : Place or None
        Where on the curve the machine is. Without it, it runs up from the curve's lowest speed.
    speed : float
        The other speed [rad/s].

    Returns
    -------
    Tracked
        The operating point there and the other stable response, or why there is none.
    """
    curve = guide.curve
    if curve is None:
        return Tracked(no_solution(guide.balance, speed, NO_CURVE))
    there, jumps = travel(curve, place or first_place(curve.branches), speed)
    if there is None:
        return Tracked(no_solution(guide.balance, speed, OUTSIDE))
    try:
        with np.errstate(all="ignore"):  # where numbers overflow there is no solution
            solution = guide.solved(there)
            if solution is None:
                return Tracked(no_solution(guide.balance, speed, NOT_FOUND))
            others = guide.others(speed, there, solution.eccentricity_max)
            other = guide.solved(others[0]) if others else None
    except ResonanceError as error:
        return Tracked(no_solution(guide.balance, speed, str(error)))
    name = branch_name(solution, others)
    return Tracked(solution, name, jumps > 0, there.stable_orbit, there, guide.current, other)
