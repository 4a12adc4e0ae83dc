"""What measured orbits say of a machine: its eccentricity, and whether the model is another's.

Every orbit is noisy, and during a jump the machine is on its way between two responses of the
model. So the model is held to differ only where most of the orbits of the last seconds do.
"""

import math
from collections import deque
from collections.abc import Mapping
from statistics import median
from typing import NamedTuple

from sfd_hbm_ros.response.tracking.measured import Agreement

NOISE = 0.05
"""Difference of an orbit from the predicted one, in clearances, that is held to be noise. Where
each of 30 coefficients has a standard deviation of 1.5 um, it is less in a clearance of 254 um."""

WINDOW = 2.0
"""How far back orbits count [s], or else the last `FEWEST`. A jump is over in half of it."""

FEWEST = 3
"""Orbits without which nothing is said."""

GONE = 60.0
"""Time without an orbit [s] after which the machine counts as not measured any more."""

_BACK = 0.8  # part of the threshold below which model and machine agree again
_MOST = 100  # orbits kept


class _Orbit(NamedTuple):
    """What is kept of an orbit: when it came [s], and what of it is more than noise."""

    time: float
    disagreement: float


class Seen(NamedTuple):
    """What measured orbits say of a machine at one time.

    Attributes
    ----------
    eccentricity : float
        The greatest of any damper, the median of the last orbits; NaN where the last is not new,
        and -inf where the machine is not measured.
    disagreement : float
        How far model and machine differ for most of the last orbits, see `Agreement`; 0 where by
        noise, NaN where it is not known.
    differs : bool
        Whether that is to be warned of.
    threshold : float
        From which disagreement on it is.
    """

    eccentricity: float
    disagreement: float
    differs: bool
    threshold: float


UNSEEN = Seen(-math.inf, math.nan, False, math.nan)
"""Of a machine that is not measured."""


class Measurements:
    """Measured orbits, one after the other; times are those of a clock that never goes back."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Begin anew, as with another machine."""
        self._eccentricities: deque[Mapping[str, float]] = deque(maxlen=FEWEST)
        self._seen = -math.inf
        self.forget_model()

    def forget_model(self) -> None:
        """Compare anew, as the model's response turns out to be another one."""
        self._orbits: deque[_Orbit] = deque(maxlen=_MOST)
        self._typical = math.nan
        self._differs = False

    def see(self, eccentricities: Mapping[str, float], now: float) -> None:
        """Take the greatest eccentricity of every damper that was measured."""
        if eccentricities:
            self._eccentricities.append(eccentricities)
            self._seen = now

    def compare(self, agreement: Agreement, now: float) -> None:
        """Take how an orbit agrees with the model."""
        counts = agreement.difference > NOISE
        self._orbits.append(_Orbit(now, agreement.disagreement if counts else 0.0))
        while len(self._orbits) > FEWEST and now - self._orbits[0].time > WINDOW:
            self._orbits.popleft()
        if len(self._orbits) >= FEWEST:  # here, as orbits come less often than is asked for it
            self._typical = median(orbit.disagreement for orbit in self._orbits)

    def eccentricities(self, now: float, age: float) -> Mapping[str, float]:
        """The newest eccentricities by their dampers; none where older than an age [s]."""
        fresh = now - self._seen <= age and self._eccentricities
        return self._eccentricities[-1] if fresh else {}

    def seen(self, threshold: float, now: float, age: float) -> Seen:
        """What the orbits say that are no older than an age [s].

        Model and machine differ from a threshold of the disagreement on, and agree again below a
        part of it. Where nothing is measured any more, nothing is held against the model.
        """
        disagreement = self._disagreement(now, age)
        self._differs = disagreement >= (_BACK * threshold if self._differs else threshold)
        return Seen(self._eccentricity(now, age), disagreement, self._differs, threshold)

    def _eccentricity(self, now: float, age: float) -> float:
        if now - self._seen > max(age, GONE):
            return -math.inf
        if now - self._seen > age:
            return math.nan
        return median(max(one.values()) for one in self._eccentricities)

    def _disagreement(self, now: float, age: float) -> float:
        fresh = self._orbits and now - self._orbits[-1].time <= age
        return self._typical if fresh else math.nan
