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
from sfd_hbm_ros.hbm.solution import greatest_distance
from sfd_hbm_ros.hbm.solve import solution_at

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

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


def with_unknowns(response: Response, speed: float | None, x: Array) -> Response:
    """A response of the same kind with other unknowns (n,), at another speed where one is given.

    Nothing is solved: unknowns that do not balance the forces make a motion, too.
    """
    rows = response.harmonics.rows
    columns = np.hsplit(
        x[: 2 * rows * len(response.journals)].reshape(rows, -1), len(response.journals)
    )
    journals = {
        name: replace(motion, coefficients=column)
        for (name, motion), column in zip(response.journals.items(), columns, strict=True)
    }
    speed = response.speed if speed is None else speed
    if isinstance(response, QuasiPeriodicResponse):
        return replace(response, speed=speed, frequency=float(x[-1]), journals=journals)
    return replace(response, speed=speed, journals=journals)


def vibration(response: Response, damper: str) -> float:
    """Greatest distance of a damper's journal from its mean position [m], zero to peak.

    A quasi-periodic response has its mean at the centre, and is known in the turning frame.
    """
    motion = response.journals[damper]
    if isinstance(response, QuasiPeriodicResponse):
        return motion.eccentricity_max * motion.clearance
    return motion.vibration


def disk_vibrations(balance: HarmonicBalance, response: Response) -> dict[str, float]:
    """Greatest distance of every disk's centre from its mean position [m], zero to peak.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine whose response it is.
    response : Solution or QuasiPeriodicResponse
        The response.

    Raises
    ------
    ResonanceError
        If a frequency meets an undamped resonance of the shaft with its journals held.
    """
    disks = [disk.name for disk in balance.machine.disks]
    harmonics = response.harmonics
    if isinstance(response, Solution):
        amplitudes = balance.response(response)
        amplitudes[0] = 0.0
        return {
            name: greatest_distance(
                harmonics, harmonics.coefficients(amplitudes[:, balance.model.stations[name]])
            )
            for name in disks
        }
    whirls = _turning_orbits(balance, response)
    return {
        name: float(np.abs(whirls[:, balance.model.stations[name][0]]).max()) for name in disks
    }


def _turning_orbits(balance: HarmonicBalance, response: QuasiPeriodicResponse) -> ComplexArray:
    """Motion x + i y in the turning frame over a period of it, (points, N) by x coordinates.

    Every whirl Z exp(i W t) is x = Re(Z exp(i W t)), y = Re(-i Z exp(i W t)).
    """
    highest = response.harmonics.highest
    multiples = np.arange(-highest, highest + 1)
    orders = 1.0 + multiples * response.frequency_ratio
    journals = np.hstack(
        [np.outer(response.whirl(name), [1.0, -1.0j]) for name in response.journals]
    )
    amplitudes = balance.condensation.at(response.speed, orders).recover(journals)
    angles = response.harmonics.angles(len(response.harmonics.fine_basis))
    turning: ComplexArray = np.exp(1j * np.multiply.outer(angles, multiples)) @ amplitudes
    return turning


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
