"""Floquet stability of a harmonic balance solution.

A small disturbance of the response obeys linear equations with the response's period: the
rotor's matrices and the film's derivatives along the orbit. Their solution over one period,
the monodromy matrix, is a product of matrix exponentials (Magnus series of fourth order, Blanes et
al. 2009, Phys. Rep. 470, 151), exact where the coefficients are constant. Those of an axisymmetric
rotor are written in the frame that turns with it, where a circular orbit stands still. The
eigenvalues of the monodromy matrix are the Floquet multipliers; one outside the unit circle makes
the response unstable.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from sfd_hbm_ros.hbm.balance import HarmonicBalance
from sfd_hbm_ros.hbm.solution import Solution
from sfd_hbm_ros.rotor import RotorModel, is_axisymmetric, reduce_model

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

REACH = 20.0
"""Multiple of the speed up to which the rotor's modes with the journals held are kept."""

_SETTLED = 1e-3  # relative change of the leading multiplier at which halving the step ends,
_EXACT = 1e-7  # which must also leave no doubt on which side of 1 it lies
_STIFF = 10.0  # norm of the Magnus series' second term beyond which the series is of no use
_LOBATTO = np.array([[2.0, -4.0, 2.0], [2.0, 5.0, -1.0], [2.0, 8.0, 2.0]]) / 12.0
_ROUNDING = 1e-6  # by which a multiplier of an undamped mode may exceed 1


class Instability(Enum):
    """How a response loses stability, by the leading multiplier."""

    FOLD = "fold"
    PERIOD_DOUBLING = "period doubling"
    NEIMARK_SACKER = "Neimark-Sacker"


@dataclass(frozen=True, eq=False)
class Stability:
    """Stability of one response.

    Attributes
    ----------
    multipliers : (m,) complex array
        Floquet multipliers of the reduced rotor, in falling order of magnitude.
    """

    multipliers: ComplexArray

    @property
    def growth(self) -> float:
        """How much the worst disturbance grows in a period beyond 1 and rounding."""
        return float(np.abs(self.multipliers[0])) - 1.0 - _ROUNDING

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
    leading = np.inf
    for steps in (32, 64, 128, 256, 512, 1024, 2048, 4096):
        with np.errstate(over="ignore", invalid="ignore"):
            monodromy = _monodromy(
                balance, rotor, solution, steps * solution.harmonics.revolutions
            )
        if not np.all(np.isfinite(monodromy)):
            continue  # steps too long for so stiff a film
        multipliers = np.linalg.eigvals(monodromy).astype(complex)
        multipliers = multipliers[np.argsort(-np.abs(multipliers))]
        before, leading = leading, abs(multipliers[0])
        if abs(leading - before) < min(_SETTLED * leading, max(_EXACT, 0.1 * abs(leading - 1.0))):
            break
    return Stability(multipliers)


def _monodromy(
    balance: HarmonicBalance, rotor: RotorModel, solution: Solution, steps: int
) -> Array:
    """Map of a disturbance (q, dq/dangle) over one period, (2m, 2m)."""
    rates = _rates(balance, rotor, solution, 2 * steps)
    first, middle, last = rates[:-1:2], rates[1::2], rates[2::2]
    h = 2.0 * np.pi * solution.harmonics.revolutions / steps
    commutators = h * h / 12.0 * (first @ last - last @ first)
    if np.linalg.norm(commutators, axis=(1, 2)).max() > _STIFF:
        parts = _lobatto_steps(h, np.stack([first, middle, last], axis=1))
    else:
        parts = expm(h / 6.0 * (first + 4.0 * middle + last) - commutators)
    monodromy = np.eye(rates.shape[1])
    for step in parts:
        monodromy = step @ monodromy
    return monodromy


def _lobatto_steps(h: float, rates: Array) -> Array:
    """Maps over steps of length h by Lobatto IIIC with three stages, (steps, 2m, 2m).

    It is of fourth order too, and L-stable (Hairer and Wanner 1996, Solving ODEs II, IV.5).

    Parameters
    ----------
    h : float
        Length of a step [rad].
    rates : (steps, 3, 2m, 2m) array
        Matrices A at the beginning, the middle and the end of each.
    """
    steps, stages, size, _ = rates.shape
    blocks = h * np.einsum("ij,sjkl->sikjl", _LOBATTO, rates)
    matrix = np.eye(stages * size) - blocks.reshape(steps, stages * size, stages * size)
    start = np.tile(np.eye(size), (steps, stages, 1))
    maps: Array = np.linalg.solve(matrix, start)[:, -size:]
    return maps


def _rates(balance: HarmonicBalance, rotor: RotorModel, solution: Solution, samples: int) -> Array:
    """Matrices A of y' = A y over a period, y = (q, dq/dangle), (samples + 1, 2m, 2m)."""
    w, m = solution.speed, rotor.size
    mass, damping, stiffness = (
        np.repeat(matrix[np.newaxis], samples, axis=0)
        for matrix in (w * w * rotor.M, w * (rotor.C + w * rotor.G), rotor.K)
    )
    rotating = is_axisymmetric(rotor)
    angle = solution.harmonics.angles(samples)
    turn = _turns(angle if rotating else np.zeros(samples))
    for (x, y), film, motion in zip(
        rotor.journals, balance.films, solution.journals.values(), strict=True
    ):
        orbit = [motion.at(angle, derivative) * w**derivative for derivative in (0, 1, 2)]
        forces = film.linearise(*orbit)
        corner = (slice(None), slice(x, y + 1), slice(x, y + 1))
        mass[corner] -= w * w * _seen(forces.by_acceleration, turn)
        damping[corner] -= w * _seen(forces.by_velocity, turn)
        stiffness[corner] -= _seen(forces.by_position, turn)
    if rotating:  # q = R p: q' = R (p' + J p), q'' = R (p'' + 2 J p' - p)
        quarter = np.kron(np.eye(m // 2), [[0.0, -1.0], [1.0, 0.0]])
        stiffness += damping @ quarter - mass
        damping += 2.0 * mass @ quarter
    rates = np.zeros((samples + 1, 2 * m, 2 * m))
    rates[:, :m, m:] = np.eye(m)
    rates[:-1, m:] = -np.linalg.solve(mass, np.concatenate([stiffness, damping], axis=2))
    rates[-1] = rates[0]
    return rates


def _turns(angle: Array) -> Array:
    """Rotations R by angles, (n, 2, 2)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)


def _seen(matrix: Array, turn: Array) -> Array:
    """The matrices R^T A R, which frames turned by R see."""
    return turn.transpose(0, 2, 1) @ matrix @ turn
