"""How many harmonics a response needs, by an estimate of what those left out would add.

A solution of K harmonics is put into the equations of K + 4. One step of Newton's method there is
the difference between both solutions but for terms of second order (Deuflhard 2011, Newton Methods
for Nonlinear Problems, sec. 2.1), and as the coefficients decay with the order, nearly the
distance from the solution of all harmonics. Four orders hold two of every parity: the response of
symmetric films has odd orders alone.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.family import MachineFamily
from sfd_hbm_ros.hbm.harmonics import MAX_MULTIPLES, Harmonics
from sfd_hbm_ros.hbm.options import OptionError
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.hbm.solve import solve
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.rotor import ResonanceError

Array = NDArray[np.float64]

_AHEAD = 4  # orders beyond the highest, in which the step is taken
_CORRECTIONS = 6  # of Newton's method, from one group of harmonics to a larger one
_GROWTH = 1.25  # of the highest order, where the estimate is too great


@dataclass(frozen=True)
class HarmonicsOptions:
    """How many harmonics are taken.

    Parameters
    ----------
    tolerance : float
        Truncation error that is allowed, of the clearance.
    fewest, most : int
        Limits of the highest order. The most bounds the cost, which grows with its square.
    revolutions : int
        Revolutions in a period, see `Harmonics`.

    Raises
    ------
    OptionError
        If a setting is out of its range.
    """

    tolerance: float = 1e-5
    fewest: int = 7
    most: int = 63
    revolutions: int = 1

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance < 1.0:
            raise OptionError(f"tolerance: {self.tolerance} is not allowed, it must be in (0, 1)")
        if self.fewest < 1:
            raise OptionError(f"harmonics: {self.fewest} is not allowed, it must be at least 1")
        if self.most < self.fewest:
            raise OptionError(
                f"harmonics: {self.fewest} at least and {self.most} at most are not allowed, the "
                "most must not be fewer"
            )

    def first(self) -> Harmonics:
        """The harmonics with which one begins."""
        return Harmonics(self.fewest, revolutions=self.revolutions)

    def more(self, harmonics: Harmonics) -> Harmonics | None:
        """A quarter more, up to the most; None where these are the most."""
        if harmonics.highest >= self.most:
            return None
        highest = min(self.most, int(np.ceil(_GROWTH * harmonics.highest)))
        return Harmonics(highest, revolutions=harmonics.revolutions)


class AccurateSolution(NamedTuple):
    """A solution with what it was found by.

    Attributes
    ----------
    balance : HarmonicBalance
        The machine and the harmonics that were taken.
    solution : Solution
        The solution.
    error : float
        Its truncation error, of the clearance; not a number where it has not converged.
    """

    balance: HarmonicBalance
    solution: Solution
    error: float


def truncation_error(balance: HarmonicBalance, solution: Solution) -> float:
    """Estimate how far a solution is from that of all harmonics.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine.
    solution : Solution
        A converged solution of it.

    Returns
    -------
    float
        Greatest distance between the journals' orbits, of the clearance; infinite where it cannot
        be computed: no more harmonics are allowed, or they meet an undamped resonance.
    """
    known = solution.harmonics
    more = _more(known)
    if more.highest == known.highest:
        return float("inf")
    try:
        equations = balance.with_harmonics(more).at(solution.speed)
        residual, jacobian = equations.linearise(
            more.change_from(known, solution.coefficients).ravel()
        )
        step: Array = np.linalg.solve(jacobian, residual).astype(float)
    except (ResonanceError, ArithmeticError, np.linalg.LinAlgError):
        return float("inf")
    return _finite_or_infinite(equations.eccentricity(step))


@dataclass(frozen=True, eq=False)
class BranchPlace:
    """A place on or near a branch of solutions.

    Attributes
    ----------
    family : MachineFamily
        The machine as the parameter varies, and the harmonics.
    value : float
        The parameter.
    x : (rows n,) array
        Coefficients [m].
    scale : float
        What a change of the parameter is compared to, in its unit.
    """

    family: MachineFamily
    value: float
    x: Array
    scale: float

    def truncation_error(self) -> float:
        """Estimate how far the branch of all harmonics is from this place.

        Near a fold a solution of all harmonics at the same value of the parameter may be far away,
        or missing, though the branch passes close by. So the parameter takes part in Newton's
        step, which is the shortest that there is.

        Returns
        -------
        float
            Of the clearance, or of the parameter's scale, whichever is greater; infinite where it
            cannot be computed.
        """
        known = self.family.balance.harmonics
        more = _more(known)
        if more.highest == known.highest:
            return float("inf")
        return self.with_harmonics(more)._stepped()[1]

    def with_harmonics(self, harmonics: Harmonics) -> "BranchPlace":
        """The same place, described by other harmonics."""
        balance = self.family.balance
        known = balance.harmonics
        x = harmonics.change_from(known, self.x.reshape(known.rows, -1)).ravel()
        family = replace(self.family, balance=balance.with_harmonics(harmonics))
        return replace(self, family=family, x=x)

    def corrected(self, tolerance: float) -> "BranchPlace | None":
        """The place of the branch nearest to it, to a tolerance; None where it leads to none."""
        place = self
        for _ in range(_CORRECTIONS):
            place, moved = place._stepped()
            if moved <= tolerance:
                return place
            if not moved < 1.0:
                return None
        return None

    def _stepped(self) -> "tuple[BranchPlace, float]":
        """The place after the shortest of Newton's steps, and how far it lies."""
        try:
            equations = self.family.at(self.value)
            residual, jacobian = equations.linearise(self.x)
            slope = self.family.slope(equations, self.value, self.x) * self.scale
            matrix = np.column_stack([jacobian * equations.scale, slope])
            step: Array = np.linalg.lstsq(matrix, residual, rcond=None)[0].astype(float)
        except (ResonanceError, ArithmeticError, np.linalg.LinAlgError):
            return self, float("inf")
        x, value = step[:-1] * equations.scale, float(step[-1])
        moved = _finite_or_infinite(max(equations.eccentricity(x), abs(value)))
        place = replace(self, value=self.value - value * self.scale, x=self.x - x)
        return place, moved


def _more(harmonics: Harmonics) -> Harmonics:
    highest = min(harmonics.highest + _AHEAD, MAX_MULTIPLES // harmonics.revolutions)
    return Harmonics(highest, revolutions=harmonics.revolutions)


def _finite_or_infinite(error: float) -> float:
    return error if np.isfinite(error) else float("inf")


def solve_accurately(
    machine: Machine,
    speed: float,
    options: HarmonicsOptions | None = None,
    start: AccurateSolution | None = None,
) -> AccurateSolution:
    """Solve at one speed with as many harmonics as the tolerance asks for.

    Parameters
    ----------
    machine : Machine
        The machine; it needs a damper.
    speed : float
        Rotor speed [rad/s], positive.
    options : HarmonicsOptions, optional
        Tolerance and limits.
    start : AccurateSolution, optional
        A converged solution of the same machine from which to begin; its harmonics are the fewest.

    Returns
    -------
    AccurateSolution
        The last one that converged, or the first where none did. Its error is above the tolerance
        where the most harmonics are too few, or more of them lead to no solution.

    Raises
    ------
    MachineError, ValueError
        See `HarmonicBalance` and `solve`.
    """
    options = options or HarmonicsOptions()
    first = start.balance if start else HarmonicBalance(machine, options.first())
    solution = solve(first, speed, start.solution if start else None)
    if not solution.converged:
        return AccurateSolution(first, solution, float("nan"))
    reached = AccurateSolution(first, solution, truncation_error(first, solution))
    while reached.error > options.tolerance:
        more = options.more(reached.balance.harmonics)
        if more is None:
            break
        balance = first.with_harmonics(more)
        solution = solve(balance, speed, reached.solution)
        if not solution.converged:
            break
        reached = AccurateSolution(balance, solution, truncation_error(balance, solution))
    return reached
