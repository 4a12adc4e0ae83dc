"""Responses of either kind: periodic ones, and quasi-periodic ones of axisymmetric machines."""

from dataclasses import replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Solution, Stability, stability
from sfd_hbm_ros.hbm.family import FamilyMember
from sfd_hbm_ros.hbm.newton import NewtonResult
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

_ROUNDING = 1e-12  # of the rotor's forces, which near its undamped poles exceed the load by far


def response_at(equations: FamilyMember, x: Array) -> Response:
    """The response of unknowns (n,) that solve equations of either kind."""
    balance, speed = equations.balance, equations.speed
    if isinstance(equations, QuasiPeriodicEquations):
        return quasi_periodic_response(balance, equations.harmonics, speed, x)
    return solution_at(balance, speed, x)


def balanced(equations: FamilyMember, result: NewtonResult, rounding: float = _ROUNDING) -> bool:
    """Whether Newton's method converged, or left only a part of the rotor's forces: rounding."""
    if result.outcome.converged:
        return True
    forces = float(np.linalg.norm(equations.rotor_force(result.x)))
    return result.residuals[-1] * equations.load <= rounding * forces


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
    if isinstance(one, QuasiPeriodicResponse) and isinstance(other, Solution):
        other = standing_response(other, one.harmonics, one.frequency)
    elif isinstance(one, Solution) and isinstance(other, QuasiPeriodicResponse):
        one = standing_response(one, other.harmonics, other.frequency)
    group = max(one.harmonics, other.harmonics, key=lambda group: group.revolutions)
    ours, theirs = (
        response.coefficients
        if response.harmonics == group
        else group.change_from(response.harmonics, response.coefficients)
        for response in (one, other)
    )
    clearances = np.repeat([motion.clearance for motion in one.journals.values()], 2)
    return float(np.abs((ours - theirs) / clearances).max())


def between(one: Response, other: Response, part: float) -> Response:
    """The response in proportion between two neighbours on a branch, which Newton can start from.

    Parameters
    ----------
    one, other : Solution or QuasiPeriodicResponse
        The neighbours, of the same kind and harmonics.
    part : float
        Part of the way from the one to the other, from 0 to 1.
    """
    speed = one.speed + part * (other.speed - one.speed)
    journals = {}
    for name, motion in one.journals.items():
        change = other.journals[name].coefficients - motion.coefficients
        journals[name] = replace(motion, coefficients=motion.coefficients + part * change)
    if isinstance(one, QuasiPeriodicResponse) and isinstance(other, QuasiPeriodicResponse):
        frequency = one.frequency + part * (other.frequency - one.frequency)
        return replace(one, speed=speed, frequency=frequency, journals=journals)
    return replace(one, speed=speed, journals=journals)
