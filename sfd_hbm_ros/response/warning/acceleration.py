"""The angular acceleration of a rotor from its stamped speeds, whatever single ones say.

The slope of a line is taken through the means of short bins of the past by the repeated median
(Siegel 1982, Biometrika 69, 242): of the slopes from each bin to all others the median, and of
these medians the median. Nothing that spoils fewer than half of the bins can move it far, so that
wrong speeds and stamps pass without a trace, and no threshold says which they are. Davies, Fried
and Gather 2004 (J. Statistical Planning and Inference 122, 65) recommend it for monitoring.

Another slope is taken over when the window is half full of it. A step of the speed leaves the
slope as it is but for three bins, as the window is half full of what came before. Independent
errors of the speed with standard deviation s, a short time d apart, leave about 1.2 times as much
in the slope as they do by least squares, s sqrt(12 d / W^3) over a window W. Errors of any kind
that are never greater than e leave no more than 9 e / W.
"""

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SECOND = 1e-9  # in a nanosecond
_BINS = 32  # of a window that is full
_FEWEST = 5  # bins before a slope means anything
_KEPT = 8  # bins that are kept however old they are, so that three may be wrong at any rate
_KNOWN = 0.25  # part of the window that must be seen before the slope is told
_CALM = 0.25  # part of the window for which a slope must last before it has settled
_FEW = 3  # slopes, in that part at least
_CHANGE = 0.25  # part of itself by which a slope that has settled may change meanwhile


@dataclass
class _Bin:
    """Speeds that came in short succession.

    Attributes
    ----------
    begin : int
        Stamp of the first [ns].
    count : int
        How many they are.
    age : float
        Mean time of them since the first [s].
    speed : float
        Their mean [rad/s].
    """

    begin: int
    count: int = 0
    age: float = 0.0
    speed: float = 0.0

    def add(self, stamp: int, speed: float) -> None:
        """Take a speed [rad/s] and its stamp [ns]."""
        self.count += 1
        self.age += ((stamp - self.begin) * _SECOND - self.age) / self.count
        self.speed += (speed - self.speed) / self.count


class AccelerationEstimator:
    """Follows the acceleration, speed by speed.

    Parameters
    ----------
    window : float
        How far back speeds count [s], positive; further where fewer than eight would. Another
        acceleration is taken over after half of it.
    resolution : float
        Acceleration beyond which the speed no longer counts as steady [rad/s2], at least 0. Below
        half of it, it counts so again, lest noise make the direction of travel flicker.

    Raises
    ------
    ValueError
        If a number is not allowed.
    """

    def __init__(self, window: float = 4.0, resolution: float = 0.02) -> None:
        if not 0.0 < window < math.inf:
            raise ValueError(f"window: {window} s is not allowed, it must be positive and finite")
        if not 0.0 <= resolution < math.inf:
            raise ValueError(
                f"resolution: {resolution} rad/s2 is not allowed, it must be finite and at least 0"
            )
        self._window = window
        self._resolution = resolution
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._bins: deque[_Bin] = deque()
        self._last = 0
        self._slope = math.nan
        self._slopes: deque[tuple[int, float]] = deque()  # the last ones, with their stamps
        self._steady = True

    def add(self, stamp: int, speed: float) -> None:
        """Take a speed [rad/s] and its stamp [ns].

        A speed that is not finite, or has the stamp of the last, is passed over. Where the stamps
        leave a gap as long as the window or go back, as by a clock that was set, the estimate
        begins anew.
        """
        if not math.isfinite(speed) or (self._bins and stamp == self._last):
            return
        if not 0.0 <= (stamp - self._last) * _SECOND <= self._window:
            self.forget()
        self._last = stamp
        if not self._bins or self._age(self._bins[-1]) >= self._window / _BINS:
            self._bins.append(_Bin(stamp))
            while len(self._bins) > _KEPT and self._age(self._bins[0]) > self._window:
                self._bins.popleft()
        self._bins[-1].add(stamp, speed)
        if self._bins[-1].count == 1:
            self._settle()

    @property
    def acceleration(self) -> float:
        """Angular acceleration [rad/s2]; 0 for a steady speed, NaN while it is unknown."""
        return 0.0 if self._steady and math.isfinite(self._slope) else self._slope

    @property
    def settled(self) -> bool:
        """Whether the acceleration has not changed much for a quarter of the window.

        While another one is taken over, after a start or a reversal, what is told of it lies
        somewhere between both.
        """
        slopes = [slope for _, slope in self._slopes]
        if len(slopes) < _FEW or not math.isfinite(self._slope):
            return False
        lasting = (self._slopes[-1][0] - self._slopes[0][0]) * _SECOND >= _CALM * self._window
        allowed = _CHANGE * abs(self._slope) + self._resolution
        return lasting and max(slopes) - min(slopes) <= allowed

    def _age(self, one: _Bin) -> float:
        """Time from the first speed of a bin to the last of all [s]."""
        return (self._last - one.begin) * _SECOND

    def _settle(self) -> None:
        """Look at the slope as a bin begins, and decide whether the speed is steady."""
        if len(self._bins) < _FEWEST or self._age(self._bins[0]) < _KNOWN * self._window:
            return
        times = np.array([one.age - self._age(one) for one in self._bins])
        self._slope = _repeated_median(times, np.array([one.speed for one in self._bins]))
        self._slopes.append((self._last, self._slope))
        while len(self._slopes) > _FEW and (
            (self._last - self._slopes[1][0]) * _SECOND >= _CALM * self._window
        ):
            self._slopes.popleft()
        bound = self._resolution if self._steady else 0.5 * self._resolution
        self._steady = abs(self._slope) <= bound


def _repeated_median(x: Array, y: Array) -> float:
    """The slope of the repeated median line through n points at different x.

    NaN where the numbers are too great for it.
    """
    n = len(x)
    others = ~np.eye(n, dtype=bool)
    with np.errstate(over="ignore", invalid="ignore"):
        slopes = np.subtract.outer(y, y)[others] / np.subtract.outer(x, x)[others]
        slope = float(np.median(np.median(slopes.reshape(n, n - 1), axis=1)))
    return slope if math.isfinite(slope) else math.nan
