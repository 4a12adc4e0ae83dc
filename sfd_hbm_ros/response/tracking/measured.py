"""A measured orbit beside the predicted ones: which branch it is on, and how well they agree.

Orbits are mappings of names to numbers, as the node publishes its harmonics: for the axes x and y
of a damper, ``damper_1/x/0x`` is the mean [m], ``damper_1/x/1x/amplitude`` the amplitude zero to
peak [m] and ``damper_1/x/1x/phase`` the lag [rad] of the harmonic of order 1 in
x = X0 + sum A_i cos(i W t - phase_i). A measured orbit may hold any of these.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Harmonics, JournalMotion, Solution

Array = NDArray[np.float64]

LIMIT = 0.5
"""Disagreement below which an orbit is recognised."""

RATIO = 0.5
"""Part of the next candidate's disagreement below which the best candidate is decisive."""


@dataclass(frozen=True)
class Agreement:
    """How a measured orbit compares with a predicted one.

    Attributes
    ----------
    residuals : mapping of str to float
        Measured minus predicted of every number that both have, by its name; phases are brought
        between -pi and pi.
    disagreement : float
        Norm of the difference of all harmonics over the greater norm of the two orbits, each in
        clearances: 0 for equal ones, at most 2. Where no phase is measured, the difference is that
        of the amplitudes. NaN where nothing can be compared.
    """

    residuals: Mapping[str, float]
    disagreement: float


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
    cos, sin = coefficients[:, 1::2], coefficients[:, 2::2] + 0.0  # no negative zero, no lag of pi
    values = coefficients.copy()
    values[:, 1::2] = np.hypot(cos, sin)
    values[:, 2::2] = np.arctan2(sin, cos)
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
    residuals = {name: _difference(name, measured[name], predicted[name]) for name in names}
    clearances = {name: motion.clearance for name, motion in solution.journals.items()}
    ours, theirs = [], []
    for name in names:
        if name.endswith("/phase"):
            continue
        clearance = clearances[name.rsplit("/", 2 if name.endswith("/0x") else 3)[0]]
        phase = name.replace("/amplitude", "/phase")
        turned = phase in residuals and phase != name
        shift = np.exp(-1j * residuals[phase]) if turned else 1.0
        theirs.append(measured[name] / clearance * shift)
        ours.append(predicted[name] / clearance)
    if not names:
        return Agreement(residuals, float("nan"))
    scale = max(np.linalg.norm(ours), np.linalg.norm(theirs))
    difference = np.linalg.norm(np.subtract(theirs, ours))
    return Agreement(residuals, float(difference / scale) if scale > 0.0 else 0.0)


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
    if least >= LIMIT:
        return Verdict(best, False, found[best], f"{per_cent} from the nearest response")
    others = [value for i, value in enumerate(disagreements) if i != best]
    if least >= RATIO * min(others, default=np.inf):
        sentence = f"{per_cent} from one response and {100.0 * min(others):.0f} % from another"
        return Verdict(best, False, found[best], sentence)
    return Verdict(best, True, found[best], f"{per_cent} from its response")


def _has_amplitude(name: str, measured: Mapping[str, float]) -> bool:
    """Whether a name is no phase, or the phase of a measured amplitude."""
    stem, _, last = name.rpartition("/")
    return last != "phase" or bool(np.isfinite(measured.get(f"{stem}/amplitude", np.nan)))


def _difference(name: str, measured: float, predicted: float) -> float:
    """Measured minus predicted."""
    difference = measured - predicted
    if not name.endswith("/phase"):
        return difference
    return float(np.angle(np.exp(1j * difference)))
