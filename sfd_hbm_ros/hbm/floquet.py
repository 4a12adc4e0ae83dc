"""Floquet stability of a harmonic balance solution.

A small disturbance of the response obeys linear equations with the response's period: the
rotor's matrices and the film's derivatives along the orbit. Those of an axisymmetric rotor are
written in the frame that turns with it, where a circular orbit stands still and the equations are
constant. The eigenvalues of the monodromy matrix, their solution over one period, are the Floquet
multipliers; one outside the unit circle makes the response unstable.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import FilmForces
from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.monodromy import monodromy, rates
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.rotor import RotorModel, is_axisymmetric, reduce_model
from sfd_hbm_ros.threads import one_blas_thread

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

REACH = 20.0
"""Multiple of the speed up to which the rotor's modes with the journals held are kept."""

_SETTLED = 1e-3  # relative change of the leading multiplier at which halving the step ends,
_EXACT = 1e-7  # which must also leave no doubt on which side of 1 it lies
_CLEAR = 1e-2  # distance from 1 within which few steps may agree by chance,
_FINE = 64  # and these many do not
_ROUND = 1e-9  # of the clearance by which a circular orbit may be off its circle
_ROUNDING = 1e-6  # by which a multiplier of an undamped mode may exceed 1


class Instability(Enum):
    """How a response loses stability, by the leading multiplier.

    At a multiplier of 1 the branch folds or, where a symmetry breaks, another leaves it: the
    multiplier alone does not tell which.
    """

    FOLD = "fold"
    PERIOD_DOUBLING = "period doubling"
    NEIMARK_SACKER = "Neimark-Sacker"
    SYMMETRY_BREAKING = "symmetry breaking"


@dataclass(frozen=True, eq=False)
class Stability:
    """Stability of one response.

    Attributes
    ----------
    multipliers : (m,) complex array
        Floquet multipliers of the reduced rotor, in falling order of magnitude.
    accuracy : float
        By how much the magnitude of one may be wrong.
    """

    multipliers: ComplexArray
    accuracy: float = _ROUNDING

    @property
    def growth(self) -> float:
        """How much the worst disturbance grows in a period, beyond what may be an error."""
        return float(np.abs(self.multipliers[0])) - 1.0 - self.accuracy

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.growth <= 0.0

    @property
    def instability(self) -> Instability | None:
        """Kind of the instability; None for a stable response."""
        if self.stable:
            return None
        leading = self.multipliers[0]
        if abs(leading.imag) > _ROUNDING * abs(leading):
            return Instability.NEIMARK_SACKER
        return Instability.FOLD if leading.real > 0 else Instability.PERIOD_DOUBLING


@one_blas_thread
def stability(balance: HarmonicBalance, solution: Solution) -> Stability:
    """Floquet stability of a converged solution.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine.
    solution : Solution
        One of its converged solutions.

    Raises
    ------
    ValueError
        If the solution did not converge.
    """
    if not solution.converged:
        raise ValueError(f"stability: there is no solution at {solution.speed} rad/s to judge")
    rotor = reduce_model(balance.model, REACH * solution.speed)
    revolutions = solution.harmonics.revolutions
    period = 2.0 * np.pi * revolutions
    if is_axisymmetric(rotor) and _is_circular(solution):
        exponents = np.linalg.eigvals(_rates(balance, rotor, solution, 1)[0])
        return Stability(_in_falling_order(np.exp(period * exponents)))
    return settled_stability(
        lambda steps: monodromy(_rates(balance, rotor, solution, 2 * steps * revolutions), period)
    )


@one_blas_thread
def settled_stability(
    monodromy_in: Callable[[int], Array], phase_is_free: bool = False
) -> Stability:
    """Floquet stability from monodromy matrices in more and more steps, until it settles.

    Where the phase of the response is free, one multiplier is 1. It is left aside, and tells how
    accurate the others are: near the clearance the response itself has too few harmonics.
    """
    leading, accuracy = np.inf, _ROUNDING
    for steps in (16, 32, 64, 128, 256, 512, 1024, 2048, 4096):
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = monodromy_in(steps)
        if not np.all(np.isfinite(matrix)):
            continue  # steps too long for so stiff a film
        multipliers = np.linalg.eigvals(matrix).astype(complex)
        if phase_is_free:
            errors = np.abs(multipliers - 1.0)
            multipliers = np.delete(multipliers, np.argmin(errors))
            accuracy = max(_ROUNDING, float(errors.min()))
        multipliers = _in_falling_order(multipliers)
        before, leading = leading, abs(multipliers[0])
        doubt = abs(leading - 1.0)
        enough = steps >= _FINE or doubt > _CLEAR
        if enough and abs(leading - before) < min(_SETTLED * leading, max(_EXACT, 0.1 * doubt)):
            break
    return Stability(multipliers, accuracy)


def _is_circular(solution: Solution) -> bool:
    """Whether the journals move on circles about the centre, forward with the rotor."""
    first = solution.harmonics.orders == 1
    for motion in solution.journals.values():
        amplitudes = motion.harmonics.amplitudes(motion.coefficients)
        x, y = amplitudes[first].T
        astray = np.concatenate([amplitudes[~first].ravel(), y + 1j * x])
        if np.abs(astray).max() > _ROUND * motion.clearance:
            return False
    return True


def _in_falling_order(multipliers: ComplexArray) -> ComplexArray:
    return multipliers[np.argsort(-np.abs(multipliers))]


def _rates(balance: HarmonicBalance, rotor: RotorModel, solution: Solution, samples: int) -> Array:
    """Matrices A of y' = A y over a period, y = (q, dq/dangle), (samples + 1, 2m, 2m)."""
    w = solution.speed
    rotating = is_axisymmetric(rotor)
    turn = _turns(solution.harmonics.angles(samples)) if rotating else None
    films = []
    for film, motion in zip(balance.films, solution.journals.values(), strict=True):
        f = film.linearise(*motion.over(samples, w))
        films.append(f if turn is None else _seen(f, turn))
    return rates(rotor, films, w, w, w if rotating else 0.0)


def _turns(angle: Array) -> Array:
    """Rotations R by angles, (n, 2, 2)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)


def _seen(f: FilmForces, turn: Array) -> FilmForces:
    """The derivatives R^T A R, which frames turned by R see, be the film isotropic or not."""
    slopes = f.by_position, f.by_velocity, f.by_acceleration
    return FilmForces(f.force, *(turn.transpose(0, 2, 1) @ slope @ turn for slope in slopes))
