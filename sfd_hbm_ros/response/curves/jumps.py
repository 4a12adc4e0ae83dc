"""The jumps that a machine makes as a parameter rises or falls through a response curve."""

import math
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise

from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.journey import Leg, first_place, legs
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.place import Place, response_on
from sfd_hbm_ros.response.responses import Response


class Direction(StrEnum):
    """Which way the parameter goes: for a speed, a run-up or a coast-down."""

    RUN_UP = "run_up"
    COAST_DOWN = "coast_down"

    @property
    def end(self) -> float:
        """The value that a journey without an end goes to."""
        return math.inf if self is Direction.RUN_UP else -math.inf


@dataclass(frozen=True, eq=False)
class Jump:
    """One jump.

    Attributes
    ----------
    direction : Direction
        Which way the parameter went.
    value : float
        The parameter: for a speed [rad/s].
    before, after : Solution or QuasiPeriodicResponse
        The last response on the branch that is left, and the one on which the machine lands.
    """

    direction: Direction
    value: float
    before: Response
    after: Response

    @property
    def damper(self) -> str:
        """The damper whose eccentricity changes most."""
        changes = {
            name: abs(motion.eccentricity_max - self.after.journals[name].eccentricity_max)
            for name, motion in self.before.journals.items()
        }
        return max(changes, key=lambda name: changes[name])


def leaps(curve: ResponseCurve, direction: Direction) -> list[Leg]:
    """Legs that end with a jump, of the journey through the whole range in one direction."""
    start = first_place(curve.branches, direction is Direction.RUN_UP)
    return [leg for leg in legs(curve, start, direction.end) if leg.landing is not None]


def jumps(curve: ResponseCurve, direction: Direction) -> list[Jump]:
    """Jumps on the way through the whole range in one direction, in the order they happen.

    The way is that of `journey.travel`; its responses are converged.
    """
    return [jump_of(leap, direction) for leap in leaps(curve, direction)]


def jump_of(leap: Leg, direction: Direction) -> Jump:
    """The jump with which a leg ends, its responses converged."""
    end, _, landing = leap
    assert landing is not None
    return Jump(direction, end.value, end.nearest, response_on(landing) or landing.nearest)


def leaps_from(curve: ResponseCurve, branch: CurveBranch, direction: Direction) -> list[Leg]:
    """Legs that end with the first jump of a machine on a detached branch, each once.

    It may land on any other branch, a detached one among them.
    """
    whole = replace(curve, branches=curve.every_branch, detached=())
    stable = [None in pair for pair in pairwise(branch.instability)]
    found: list[Leg] = []
    for index, here in enumerate(stable):
        if here and not (index and stable[index - 1]):
            middle = float(branch.values[index : index + 2].mean())
            leg = next(legs(whole, Place(branch, index, middle), direction.end))
            if leg.landing is not None and not any(leg.end.is_at(one.end) for one in found):
                found.append(leg)
    return found
