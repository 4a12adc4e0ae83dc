"""The angular acceleration of a rotor from its stamped speeds.

A line is fitted to the past speeds by least squares, weighted by exp(-age/T). It follows a steady
ramp without lag, takes samples at any distance in time, and needs no memory of them: a few sums
are carried on (the fading-memory polynomial filter of degree one, Morrison 1969; for samples at a
constant rate it settles to the critically damped alpha-beta filter). Independent errors of the
speed with standard deviation s, a short time d apart, leave s sqrt(d / (4 T^3)) in the slope.
"""

import math

_SECOND = 1e-9  # in a nanosecond
_FEWEST = 5  # speeds before a slope means anything
_FADED = 3.0  # time constants without a speed after which the estimate begins anew


class AccelerationEstimator:
    """Follows the acceleration, speed by speed.

    Parameters
    ----------
    time_constant : float
        Age T at which the weight of a speed has fallen to 1/e [s], positive. A change of the
        acceleration is followed within about two of them.
    resolution : float
        Acceleration beyond which the speed no longer counts as steady [rad/s2], at least 0. Below
        half of it, it counts so again, lest noise make the direction of travel flicker.

    Raises
    ------
    ValueError
        If a number is not allowed.
    """

    def __init__(self, time_constant: float = 1.0, resolution: float = 0.02) -> None:
        if not 0.0 < time_constant < math.inf:
            raise ValueError(
                f"time_constant: {time_constant} s is not allowed, it must be positive and finite"
            )
        if not 0.0 <= resolution < math.inf:
            raise ValueError(
                f"resolution: {resolution} rad/s2 is not allowed, it must be finite and at least 0"
            )
        self._time_constant = time_constant
        self._resolution = resolution
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._count = 0
        self._span = 0.0
        self._last = 0
        self._steady = True
        self._weights = 0.0, 0.0, 0.0  # sums of the weights times 1, t and t^2, now being t = 0,
        self._speeds = 0.0, 0.0  # and of the weighted speeds times 1 and t

    def add(self, stamp: int, speed: float) -> None:
        """Take a speed [rad/s] and its stamp [ns].

        A speed that is not finite, or not newer than the last, is passed over. Where the stamps
        leave a gap, forwards or backwards, the estimate begins anew.
        """
        if not math.isfinite(speed):
            return
        if abs(self._since(stamp)) > _FADED * self._time_constant:
            self.forget()
        elapsed = self._since(stamp)
        if self._count and elapsed <= 0.0:
            return
        self._advance(elapsed, speed)
        self._count += 1
        self._span += elapsed
        self._last = stamp
        self._settle()

    @property
    def acceleration(self) -> float:
        """Angular acceleration [rad/s2]; 0 for a steady speed, NaN while it is unknown."""
        if not self._known:
            return math.nan
        return 0.0 if self._steady else self._slope

    @property
    def _known(self) -> bool:
        return self._count >= _FEWEST and self._span >= self._time_constant

    @property
    def _slope(self) -> float:
        one, t, t2 = self._weights
        speed, t_speed = self._speeds
        return (one * t_speed - t * speed) / (one * t2 - t * t)

    def _since(self, stamp: int) -> float:
        """Time from the last speed to a stamp [s]; 0 where there is no last."""
        return (stamp - self._last) * _SECOND if self._count else 0.0

    def _advance(self, elapsed: float, speed: float) -> None:
        """Let time pass [s], so that the past moves away from t = 0 and fades, and add a speed."""
        one, t, t2 = self._weights
        past, t_past = self._speeds
        fade = math.exp(-elapsed / self._time_constant)
        self._weights = (
            fade * one + 1.0,
            fade * (t - elapsed * one),
            fade * (t2 - 2.0 * elapsed * t + elapsed**2 * one),
        )
        self._speeds = fade * past + speed, fade * (t_past - elapsed * past)

    def _settle(self) -> None:
        """Decide whether the speed is steady."""
        if self._known:
            bound = self._resolution if self._steady else 0.5 * self._resolution
            self._steady = abs(self._slope) <= bound
