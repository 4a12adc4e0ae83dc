"""The response at one speed: from a neighbour, from a first guess, or by raising the load."""

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.balance import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import LoadFamily, SpeedFamily
from sfd_hbm_ros.hbm.newton import NewtonResult, Outcome, newton
from sfd_hbm_ros.hbm.options import DEFAULTS, ContinuationOptions, NewtonOptions
from sfd_hbm_ros.hbm.solution import JournalMotion, Solution
from sfd_hbm_ros.rotor import ResonanceError
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]

_SHORT = ContinuationOptions(longest_step=0.1, points=150)  # a live prediction has to end
_DETOUR = 0.05  # of the speed, by which a branch may turn back between two folds
_BOUNDLESS = 1e6  # sag, of the clearance, that only rounding keeps from being infinite
_GUESS_LIMIT = 0.7  # eccentricity to which a linear guess is scaled down


@one_blas_thread
def solve(
    balance: HarmonicBalance,
    speed: float,
    start: Solution | None = None,
    options: NewtonOptions = DEFAULTS,
) -> Solution:
    """Solve the harmonic balance at one speed.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    speed : float
        Rotor speed [rad/s], positive.
    start : Solution, optional
        A converged solution at a speed nearby. Newton's method starts from it and, where that
        fails, its branch is followed to the speed, through folds. Otherwise the
        response with the films' linear coefficients is the start, and if need be the load is
        raised step by step.
    options : NewtonOptions
        Tolerance and limits.

    Returns
    -------
    Solution
        Converged, or with the outcome and history of the last attempt.

    Raises
    ------
    ValueError
        If the speed is not a positive, finite number.
    """
    if not (np.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed: {speed} rad/s is not allowed, it must be positive and finite")
    try:
        with np.errstate(all="ignore"):
            return _solve(balance, speed, start, options)
    except (OverflowError, np.linalg.LinAlgError):
        return _failure(balance, speed, Outcome.RANGE, Outcome.RANGE.value)


def _solve(
    balance: HarmonicBalance, speed: float, start: Solution | None, options: NewtonOptions
) -> Solution:
    try:
        equations = balance.at(speed)
    except ResonanceError as error:
        return _failure(balance, speed, Outcome.RESONANCE, str(error))
    result = None
    if start is not None and start.converged:
        x = balance.harmonics.change_from(start.harmonics, start.coefficients).ravel()
        if equations.eccentricity(x) < 1.0:
            result = newton(equations, x, options)
            if not result.outcome.converged and start.speed != speed:
                result = _follow_speed(balance, start.speed, x, speed, options)
    message = Outcome.CONVERGED.value
    if result is None or not result.outcome.converged:
        result, message = solve_equations(equations, options)
    if not result.outcome.converged:
        return _failure(balance, speed, result.outcome, message, result.residuals)
    return _solution(balance, speed, result.x, result.outcome, message, result.residuals)


@one_blas_thread
def solve_equations(
    equations: Equations, options: NewtonOptions = DEFAULTS
) -> tuple[NewtonResult, str]:
    """Solve from the first guess or, where that fails, by raising the load.

    Returns
    -------
    The last result, and its outcome as a sentence.
    """
    result = newton(equations, first_guess(equations), options)
    if result.outcome.converged:
        return result, result.outcome.value
    return raise_load(equations, options)


def first_guess(equations: Equations) -> Array:
    """Response with the films' small-motion coefficients, scaled to lie within the clearance."""
    matrix = equations.linear + equations.linear_film
    x: Array = np.linalg.solve(matrix, equations.force.ravel()).astype(float)
    eccentricity = equations.eccentricity(x)
    return x if eccentricity <= _GUESS_LIMIT else x * (_GUESS_LIMIT / eccentricity)


def raise_load(equations: Equations, options: NewtonOptions) -> tuple[NewtonResult, str]:
    """Solve under the unbalance alone, then with more and more of the static load.

    Where the unbalance alone has no solution from the first guess, it is raised from zero too.

    Returns
    -------
    The last result, and its outcome as a sentence.
    """
    static = np.zeros_like(equations.force)
    static[0] = equations.force[0]
    unbalance = equations.force - static
    alone = equations.with_force(unbalance)
    result = newton(alone, first_guess(alone), options)
    message = result.outcome.value
    if not result.outcome.converged:
        nothing = np.zeros_like(unbalance)
        result, message = _follow_load(equations, nothing, unbalance, nothing.ravel(), options)
    if result.outcome.converged and static.any():
        result, message = _follow_load(equations, unbalance, static, result.x, options)
    return result, message


def _follow_speed(
    balance: HarmonicBalance, start: float, x: Array, speed: float, options: NewtonOptions
) -> NewtonResult | None:
    """Follow the branch through x at the speed `start` to where it comes through another speed.

    Where it turns back on the way, it is followed through its folds: a machine that jumps there
    lands on what comes behind them. None where the branch does not lead to the speed.
    """
    behind = start - np.sign(speed - start) * _DETOUR * start
    try:
        corrected = newton(balance.at(start), x, options)  # the machine may have changed since
        if not corrected.outcome.converged:
            return None
        *_, last = Branch(
            SpeedFamily(balance), corrected.x, start, speed, (behind, speed), _SHORT, options
        )
        return newton(balance.at(speed), last.x, options) if last.value == speed else None
    except ResonanceError:
        return None


def _follow_load(
    equations: Equations, base: Array, part: Array, x: Array, options: NewtonOptions
) -> tuple[NewtonResult, str]:
    """Follow the branch from the force `base`, where x is the solution, to `base` + `part`.

    It is followed by arclength, as it may fold on the way.
    """
    family = LoadFamily(equations, base, part)
    branch = Branch(family, x, 0.0, 1.0, options=_SHORT, newton=options)
    *_, last = branch
    result = newton(equations.with_force(base + last.value * part), last.x, options)
    if last.value == 1.0 and result.outcome.converged:
        return result, f"{result.outcome.value}, reached by raising the load"
    reason = branch.stop.value if branch.stop else result.outcome.value
    sentence = f"{Outcome.LOAD.value}: beyond {100.0 * last.value:.2f} % of it {reason}"
    return NewtonResult(last.x, Outcome.LOAD, result.residuals), sentence


def solution_at(balance: HarmonicBalance, speed: float, x: Array) -> Solution:
    """Solution of converged coefficients (rows n,) that another method has found."""
    return _solution(balance, speed, x, Outcome.CONVERGED, Outcome.CONVERGED.value, ())


def static_sags(balance: HarmonicBalance) -> dict[str, float]:
    """How far the journals sag under the static loads, by damper, of the clearance.

    They hang on the shaft and on their centring springs alone: at rest a film bears nothing. The
    sag is infinite where nothing else bears the loads.
    """
    condensed = balance.condensation.at(1.0, [0.0])  # the speed is of no account
    force = condensed.force[0].real
    names = [damper.name for damper in balance.machine.dampers]
    if not force.any():
        return dict.fromkeys(names, 0.0)
    try:
        q: Array = np.linalg.solve(condensed.stiffness[0].real, force).astype(float)
    except np.linalg.LinAlgError:
        q = np.full(force.size, np.inf)
    sags = np.hypot(*(q / balance.clearances).reshape(-1, 2).T)
    sags[~(sags < _BOUNDLESS)] = np.inf
    return dict(zip(names, sags.tolist(), strict=True))


def sag_sentences(balance: HarmonicBalance) -> list[str]:
    """What is to be said of every damper whose journal sags beyond its clearance."""
    clearances = {damper.name: damper.clearance for damper in balance.machine.dampers}
    return [
        f"at rest {name} sags by {sag:.2f} of its clearance ({1e6 * sag * clearances[name]:.0f} "
        f"um of {1e6 * clearances[name]:.0f} um) on its centring spring, so that its journal "
        "lies on the housing"
        if np.isfinite(sag)
        else f"at rest nothing holds the journal of {name}: it lies on the housing"
        for name, sag in static_sags(balance).items()
        if sag >= 1.0
    ]


def _failure(
    balance: HarmonicBalance,
    speed: float,
    outcome: Outcome,
    message: str,
    residuals: tuple[float, ...] = (),
) -> Solution:
    if outcome is Outcome.LOAD:
        message = "; ".join([message, *sag_sentences(balance)])
    nowhere = np.full((balance.harmonics.rows, len(balance.clearances)), np.nan)
    return _solution(balance, speed, nowhere, outcome, message, residuals)


def _solution(
    balance: HarmonicBalance,
    speed: float,
    x: Array,
    outcome: Outcome,
    message: str,
    residuals: tuple[float, ...],
) -> Solution:
    columns = np.hsplit(x.reshape(balance.harmonics.rows, -1), len(balance.films))
    journals = {
        damper.name: JournalMotion(damper.name, damper.clearance, balance.harmonics, q)
        for damper, q in zip(balance.machine.dampers, columns, strict=True)
    }
    return Solution(speed, balance.harmonics, outcome, message, residuals, journals)
