"""As many harmonics as a whole curve needs, and how far its points are from all of them.

The curve is followed once, roughly and without its stability, with few harmonics; where these are
too few by their own estimate, more are taken from there on. The curve itself is then computed with
the most that was needed anywhere.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import MachineFamily, ParameterFamily, SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.quasi_periodic_branch import has_circular_orbits
from sfd_hbm_ros.hbm.truncation import BranchPlace, HarmonicsOptions
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch, Progress
from sfd_hbm_ros.threads import one_blas_thread

_ROUGH = ContinuationOptions(first_step=0.05, longest_step=0.15, turning=0.6)
_MARGIN = 0.5  # of the tolerance that is kept there, as the worst may lie between two points
_LOOKED_AT = 24  # points of a branch, and that of the greatest eccentricity, in `curve_error`

FamilyOf = Callable[[HarmonicBalance], MachineFamily]


@one_blas_thread
def balance_for_speeds(
    machine: Machine,
    lowest: float,
    highest: float,
    options: HarmonicsOptions | None = None,
    progress: Progress | None = None,
) -> HarmonicBalance:
    """A machine balanced in the harmonics that its response over a range of speeds needs.

    Parameters
    ----------
    machine : Machine
        The machine; it needs a damper.
    lowest, highest : float
        Range of the speed [rad/s].
    options : HarmonicsOptions, optional
        Tolerance and limits.
    progress : callable, optional
        Called with the speed of every point on the way.
    """
    return _balance(machine, SpeedFamily, (lowest, highest), options, progress)


@one_blas_thread
def balance_for_entry(
    machine: Machine,
    speed: float,
    path: str,
    bounds: tuple[float, float],
    options: HarmonicsOptions | None = None,
    progress: Progress | None = None,
) -> HarmonicBalance:
    """The same for a range of an entry of the machine file at one speed [rad/s]."""
    family_of = partial(ParameterFamily, speed=speed, path=path)
    return _balance(machine, family_of, bounds, options, progress)


@one_blas_thread
def curve_error(curve: ResponseCurve) -> float:
    """Greatest distance of a curve's periodic branches from those of all harmonics.

    It is estimated at some two dozen points of each branch, among them that of the greatest
    eccentricity, and is a part of the clearance, or of the parameter's greatest value.
    """
    return max(
        (
            _place(curve.family, branch, i).truncation_error()
            for branch in curve.every_branch
            if branch.periodic
            for i in _looked_at(branch)
        ),
        default=float("nan"),
    )


def _place(family: MachineFamily, branch: CurveBranch, point: int) -> BranchPlace:
    orbit = branch.orbits[point]
    own = replace(family, balance=family.balance.with_harmonics(orbit.harmonics))
    scale = float(np.abs(branch.values).max())
    return BranchPlace(own, float(branch.values[point]), orbit.coefficients.ravel(), scale)


def _looked_at(branch: CurveBranch) -> list[int]:
    last = len(branch.values) - 1
    even = np.linspace(0, last, min(last + 1, _LOOKED_AT)).round().astype(int)
    return sorted({*even.tolist(), int(branch.worst_eccentricity.argmax())})


def _balance(
    machine: Machine,
    family_of: FamilyOf,
    bounds: tuple[float, float],
    options: HarmonicsOptions | None,
    progress: Progress | None,
) -> HarmonicBalance:
    options = options or HarmonicsOptions()
    first = HarmonicBalance(machine, options.first())
    if options.fewest == options.most or has_circular_orbits(first):
        return first
    family, needed = family_of(first), first.harmonics
    scale = max(map(abs, bounds))
    for start, end in (bounds, bounds[::-1]):
        member = family.at(start)
        solution = solve(member.balance, member.speed)
        if not solution.converged:
            continue
        branch = Branch(family, solution.coefficients.ravel(), start, end, options=_ROUGH)
        for point in branch:
            if progress is not None:
                progress(point.value)
            place = BranchPlace(family, point.value, point.x, scale)
            needed = _enlarged(needed, place, options)
        if branch.stop is Stop.RANGE and point.value == end:
            break
    return first.with_harmonics(needed)


def _enlarged(needed: Harmonics, place: BranchPlace, options: HarmonicsOptions) -> Harmonics:
    """The harmonics needed so far, or more of them where they are too few at a place."""
    while place.truncation_error() > _MARGIN * options.tolerance:
        known = place.family.balance.harmonics
        more = needed if known.highest < needed.highest else options.more(known)
        larger = place.with_harmonics(more).corrected(options.tolerance) if more else None
        if larger is None:
            break
        place = larger
    return max(needed, place.family.balance.harmonics, key=lambda harmonics: harmonics.highest)
