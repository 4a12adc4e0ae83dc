"""Responses of either kind: periodic ones, and quasi-periodic ones of axisymmetric machines."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Solution, Stability, stability
from sfd_hbm_ros.hbm.family import FamilyMember
from sfd_hbm_ros.hbm.quasi_periodic import QuasiPeriodicEquations
from sfd_hbm_ros.hbm.quasi_periodic_response import (
    QuasiPeriodicResponse,
    quasi_periodic_response,
    quasi_periodic_stability,
    standing_response,
)
from sfd_hbm_ros.hbm.solve import solution_at

Array = NDArray[np.float64]

Response: TypeAlias = Solution | QuasiPeriodicResponse

SAME = 1e-5
"""Distance, of the clearance, within which two responses are one."""


def response_at(equations: FamilyMember, x: Array) -> Response:
    """The response of unknowns (n,) that solve equations of either kind."""
    balance, speed = equations.balance, equations.speed
    if isinstance(equations, QuasiPeriodicEquations):
        return quasi_periodic_response(balance, equations.harmonics, speed, x)
    return solution_at(balance, speed, x)


def stability_of(balance: HarmonicBalance, response: Response) -> Stability:
    """Floquet stability of a response; a quasi-periodic one is judged in the turning frame."""
    if isinstance(response, QuasiPeriodicResponse):
        return quasi_periodic_stability(balance, response)
    return stability(balance, response)


def distance(one: Response, other: Response) -> float:
    """Greatest difference of the coefficients of two responses, of the clearance.

    Periodic ones may be balanced over different numbers of revolutions. A periodic response is
    a circular orbit where others are quasi-periodic, and is compared to them in their frame.
    """
    return apart(one, one.coefficients, other)


def apart(one: Response, coefficients: Array, other: Response) -> float:
    """As `distance`, with other coefficients (rows, n) in the place of the first response's."""
    theirs = other.coefficients
    if isinstance(one, QuasiPeriodicResponse) and isinstance(other, Solution):
        theirs = standing_response(other, one.harmonics, one.frequency).coefficients
    elif isinstance(one, Solution) and isinstance(other, QuasiPeriodicResponse):
        coefficients = standing_response(one, other.harmonics, other.frequency).coefficients
    elif one.harmonics != other.harmonics:
        both = max(one.harmonics, other.harmonics, key=lambda group: group.revolutions)
        coefficients = both.change_from(one.harmonics, coefficients)
        theirs = both.change_from(other.harmonics, theirs)
    clearances = np.repeat([motion.clearance for motion in one.journals.values()], 2)
    return float(np.abs((coefficients - theirs) / clearances).max())
