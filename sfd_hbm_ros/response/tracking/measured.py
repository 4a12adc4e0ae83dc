"""A measured orbit beside the predicted ones: which branch it is on, and how well they agree.

Orbits are mappings of names to numbers, as the node publishes its harmonics: for the axes x and y
of a damper, ``damper_1/x/0x`` is the mean [m], ``damper_1/x/1x/amplitude`` the amplitude zero to
peak [m] and ``damper_1/x/1x/phase`` the lag [rad] of the harmonic of order 1 in
x = X0 + sum A_i cos(i W t - phase_i). A measured orbit may hold any of these. A phase is NaN where
its amplitude lies below `FLOOR`: there it would be that of what the solution is not exact to.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Harmonics, JournalMotion, Solution

Array = NDArray[np.float64]

LIMIT = 0.5
"""Disagreement below which an orbit is recognised."""

RATIO = 0.5
"""Part of the next candidate's disagreement below which the best candidate is decisive."""

FLOOR = 1e-5
"""Amplitude, of the clearance, below which a phase means nothing: the harmonics left out are kept
below it, and what is left of the forces is far less."""

FARTHEST = 10.0
"""Clearances beyond which no journal goes, whatever the probe: such a number is no length in m."""

_UNITS = (("mm", 1e-3), ("mil", 2.54e-5), ("um", 1e-6))  # what lengths may be in, in m
_AS_IF = (  # factors that bring other measures of a vibration to zero to peak
    (0.5, "peak to peak amplitudes"),
    (math.sqrt(2.0), "effective values"),
)
_SURE = (0.25, 0.05)  # disagreement with the given numbers and with those brought to zero to peak
_DENOMINATOR = 12  # greatest of an order that is looked at, whose period is as many revolutions
_PER_REVOLUTION = 128  # points of a measured orbit at least,
_PER_ORDER = 8  # and of its highest order
_MOST_POINTS = 8192
_MOST_TERMS = 64  # of an axis

Terms: TypeAlias = dict[Fraction, tuple[float, float]]
"""Orders with amplitudes [m] and lags [rad], NaN where these are unknown."""


@dataclass(frozen=True)
class Agreement:
    """How a measured orbit compares with a predicted one.

    Attributes
    ----------
    residuals : mapping of str to float
        Measured minus predicted of every number that both have, by its name; phases are brought
        between -pi and pi, and are NaN where an amplitude lies below `FLOOR`.
    disagreement : float
        Norm of the difference of all harmonics over the greater norm of the two orbits, each in
        clearances: 0 for equal ones, at most 2. Where no phase is measured, the difference is that
        of the amplitudes. NaN where nothing can be compared.
    difference : float
        Norm of that difference itself, in clearances.
    """

    residuals: Mapping[str, float]
    disagreement: float
    difference: float


@dataclass(frozen=True, eq=False)
class Verdict:
    """On which of several responses a machine is, by its measured orbit.

    Attributes
    ----------
    best : int
        The candidate that agrees best.
    decisive : bool
        Whether it agrees better than `LIMIT`, and every other one worse by a factor of 1/`RATIO`.
    agreement : Agreement
        That of the best candidate.
    message : str
        The verdict as a sentence.
    """

    best: int
    decisive: bool
    agreement: Agreement
    message: str


def named_harmonics(journals: Mapping[str, JournalMotion]) -> dict[str, float]:
    """The harmonics of all journals by their names."""
    named: dict[str, float] = {}
    for motion in journals.values():
        names = harmonic_names(motion.name, motion.harmonics)
        named.update(zip(names, harmonic_values(motion).tolist(), strict=True))
    return named


@lru_cache(maxsize=64)
def harmonic_names(damper: str, harmonics: Harmonics) -> tuple[str, ...]:
    """Names of a journal's harmonics, those of x first; kept, as they are asked for all the time.

    Parameters
    ----------
    damper : str
        The journal's damper.
    harmonics : Harmonics
        The orders.
    """
    parts = ["0x"]
    for order in harmonics.orders[1:]:
        parts += [f"{order:g}x/amplitude", f"{order:g}x/phase"]
    return tuple(f"{damper}/{axis}/{part}" for axis in "xy" for part in parts)


def harmonic_values(motion: JournalMotion) -> Array:
    """The numbers of a journal's harmonics, in the order of `harmonic_names`, (2 rows,)."""
    coefficients = motion.coefficients.T
    cos, sin = (
        coefficients[:, 1::2],
        coefficients[:, 2::2] + 0.0,
    )  # no negative zero, no -pi
    values = coefficients.copy()
    values[:, 1::2] = amplitudes = np.hypot(cos, sin)
    phases = np.arctan2(sin, cos)
    phases[amplitudes < FLOOR * motion.clearance] = np.nan
    values[:, 2::2] = phases
    return values.ravel()


def agreement(measured: Mapping[str, float], solution: Solution) -> Agreement:
    """Compare a measured orbit with a predicted one.

    Names that the prediction does not have are left out, and so are numbers that are not finite
    and phases without an amplitude.
    """
    predicted = named_harmonics(solution.journals)
    names = [
        name
        for name, value in measured.items()
        if name in predicted and np.isfinite(value) and _has_amplitude(name, measured)
    ]
    clearances = {name: motion.clearance for name, motion in solution.journals.items()}
    residuals: dict[str, float] = {}
    ours, theirs = [], []
    for name in names:
        difference, clearance = measured[name] - predicted[name], clearances[_damper(name)]
        if not name.endswith("/phase"):
            residuals[name] = difference
            phase = name.replace("/amplitude", "/phase")
            turn = 0.0 if phase == name else _turn(phase, measured, predicted)
            theirs.append(measured[name] / clearance * np.exp(-1j * turn))
            ours.append(predicted[name] / clearance)
        elif measured[name.replace("/phase", "/amplitude")] < FLOOR * clearance:
            residuals[name] = math.nan
        else:
            residuals[name] = float(np.angle(np.exp(1j * difference)))
    if not names:
        return Agreement(residuals, math.nan, math.nan)
    scale = max(np.linalg.norm(ours), np.linalg.norm(theirs))
    apart = float(np.linalg.norm(np.subtract(theirs, ours)))
    return Agreement(residuals, apart / float(scale) if scale > 0.0 else 0.0, apart)


def verdict(measured: Mapping[str, float], candidates: Sequence[Solution]) -> Verdict:
    """Pick the response that a measured orbit shows.

    Parameters
    ----------
    measured : mapping of str to float
        The measured orbit, or a part of it.
    candidates : sequence of Solution
        The stable responses at the measured speed, one at least.
    """
    found = [agreement(measured, candidate) for candidate in candidates]
    disagreements = [one.disagreement for one in found]
    best = int(np.argmin(disagreements))
    least = disagreements[best]
    if np.isnan(least):
        return Verdict(best, False, found[best], "nothing measured can be compared")
    per_cent = f"the measured orbit differs by {100.0 * least:.0f} %"
    hint = _measure_hint(measured, candidates) if least > _SURE[0] else ""
    if least >= LIMIT:
        sentence = f"{per_cent} from the nearest response{hint}"
        return Verdict(best, False, found[best], sentence)
    others = [value for i, value in enumerate(disagreements) if i != best]
    if least >= RATIO * min(others, default=np.inf):
        sentence = f"{per_cent} from one response and {100.0 * min(others):.0f} % from another"
        return Verdict(best, False, found[best], sentence + hint)
    return Verdict(best, True, found[best], f"{per_cent} from its response{hint}")


def unit_hint(measured: Mapping[str, float], clearances: Mapping[str, float]) -> str:
    """What is wrong with measured numbers that can be no lengths in m, in words; '' if nothing is.

    Parameters
    ----------
    measured : mapping of str to float
        The measured orbit.
    clearances : mapping of str to float
        Those of the dampers [m].
    """
    sizes = {
        name: abs(value) / clearances[_damper(name)]
        for name, value in measured.items()
        if _damper(name) in clearances and not name.endswith("/phase")
    }
    name = max(sizes, key=lambda one: sizes[one], default="")
    if not name or sizes[name] <= FARTHEST:
        return ""
    value, clearance = measured[name], clearances[_damper(name)]
    odd = f"{name} must be in m, where {value:g} m is {sizes[name]:.3g} times the clearance"
    if sizes[name] * 1e-3 > 1.0 >= abs(value):  # which mm would be too great
        return f"{odd}: were {value:g} of the clearance meant, which are {value * clearance:g} m?"
    for unit, factor in _UNITS:
        if sizes[name] * factor <= 1.0:
            return f"{odd}: were {value:g} {unit} meant, which are {value * factor:g} m?"
    return odd


def measured_eccentricities(
    measured: Mapping[str, float], clearances: Mapping[str, float]
) -> dict[str, float]:
    """Greatest eccentricities of measured orbits, for which no model is needed.

    What is not measured counts as 0. Where a phase is missing, y lags x by a quarter turn, as in
    forward whirl, and the orders meet at their peaks.

    Parameters
    ----------
    measured : mapping of str to float
        The measured orbit.
    clearances : mapping of str to float
        Those of the dampers [m].

    Returns
    -------
    By the names of those dampers of which a mean or an amplitude is measured.
    """
    found = {}
    for damper, clearance in clearances.items():
        orbit = {axis: _terms(measured, damper, axis) for axis in "xy"}
        if any(orbit.values()):
            found[damper] = _farthest(orbit) / clearance
    return found


def _has_amplitude(name: str, measured: Mapping[str, float]) -> bool:
    """Whether a name is no phase, or the phase of a measured amplitude."""
    stem, _, last = name.rpartition("/")
    return last != "phase" or bool(np.isfinite(measured.get(f"{stem}/amplitude", np.nan)))


def _damper(name: str) -> str:
    """The damper of a name."""
    return name.rsplit("/", 2 if name.endswith("/0x") else 3)[0]


def _turn(phase: str, measured: Mapping[str, float], predicted: Mapping[str, float]) -> float:
    """By how much a measured harmonic is turned from the predicted one; 0 where that is open."""
    turn = measured.get(phase, math.nan) - predicted[phase]
    return turn if math.isfinite(turn) else 0.0


def _measure_hint(measured: Mapping[str, float], candidates: Sequence[Solution]) -> str:
    """In what other measure of vibrations the orbit agrees with a response, if surely in one."""
    amplitudes = [name for name in measured if name.endswith("/amplitude")]
    if len(amplitudes) < 2:
        return ""
    for factor, words in _AS_IF:
        scaled = {**measured, **{name: factor * measured[name] for name in amplitudes}}
        if min(agreement(scaled, one).disagreement for one in candidates) < _SURE[1]:
            return f", and by less than {100.0 * _SURE[1]:.0f} % if it holds {words}"
    return ""


@lru_cache(maxsize=256)
def _order(text: str) -> Fraction:
    """The order that a name holds, with a period that is not too long."""
    return Fraction(text).limit_denominator(_DENOMINATOR)


def _terms(measured: Mapping[str, float], damper: str, axis: str) -> Terms:
    """The greatest of the terms of an axis, as many as `_MOST_TERMS`."""
    stem = f"{damper}/{axis}/"
    terms: Terms = {}
    for name, value in measured.items():
        if name.startswith(stem) and not name.endswith("/phase"):
            order = _order(name.removeprefix(stem).partition("x")[0])
            lag = measured.get(name.replace("/amplitude", "/phase"), math.nan) if order else 0.0
            terms[order] = value, lag
    return dict(sorted(terms.items(), key=lambda term: -abs(term[1][0]))[:_MOST_TERMS])


def _farthest(orbit: Mapping[str, Terms]) -> float:
    """Greatest distance from the centre [m]."""
    orders = {order for terms in orbit.values() for order in terms}
    revolutions = math.lcm(*(order.denominator for order in orders))
    points = revolutions * max(_PER_REVOLUTION, _PER_ORDER * math.ceil(max(orders)))
    angle = np.linspace(0.0, 2.0 * np.pi * revolutions, min(points, _MOST_POINTS), endpoint=False)
    squares = np.zeros_like(angle)
    for axis, behind in (("x", 0.0), ("y", 0.5 * np.pi)):
        terms = []
        for order, (amplitude, lag) in orbit[axis].items():
            _, lag_x = orbit["x"].get(order, (0.0, math.nan))
            assumed = (lag_x if math.isfinite(lag_x) else 0.0) + (behind if order else 0.0)
            terms.append((float(order), amplitude, lag if math.isfinite(lag) else assumed))
        if terms:
            orders, amplitudes, lags = np.array(terms).T
            squares += (amplitudes @ np.cos(np.outer(orders, angle) - lags[:, None])) ** 2
    return math.sqrt(float(squares.max()))
