"""Numbers for people, which stay what they are while a machine breathes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

_BACK = 0.9  # times a bound, below which a lesser one is told
_SECONDS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600)
_MINUTE, _LONGEST = 60, 3600  # s


class Rounding:
    """Rounds the numbers of a sentence, with memory: they change no sooner than they must.

    Each number of the sentence has a key of its own.
    """

    def __init__(self) -> None:
        self._shown: dict[str, float] = {}

    def nearest(self, key: str, value: float, step: float) -> float:
        """A multiple of a step that is near a value, the last one as long as it is near."""
        shown = self._shown.get(key, math.nan)
        if not abs(value - shown) <= 0.75 * step:
            shown = round(value / step) * step
        return self._keep(key, shown)

    def rpm(self, key: str, value: float) -> str:
        """Where a speed [rpm] lies, in words."""
        return f"{self.nearest(key, value, 1.0 if value < 1e4 else 10.0):.0f} rpm"

    def within_rpm(self, key: str, value: float) -> str:
        """Below what a difference of speeds [rpm] lies, in words."""
        return f"less than {self._bound(key, value, _decimal):.0f} rpm"

    def within_time(self, key: str, value: float) -> str:
        """Below what a time [s] lies, in words."""
        if value >= _LONGEST:
            self._shown.pop(key, None)
            return "more than an hour"
        bound = self._bound(key, value, lambda below: _above(below, _SECONDS))
        minutes = bound > _MINUTE
        return f"less than {bound / _MINUTE if minutes else bound:.0f} {'min' if minutes else 's'}"

    def _bound(self, key: str, value: float, least: Callable[[float], float]) -> float:
        """The least bound of a value, or a greater one told before that is near."""
        shown = self._shown.get(key, math.nan)
        near = least(value / _BACK)
        if not value <= shown <= near:
            shown = least(value)
        return self._keep(key, shown)

    def _keep(self, key: str, value: float) -> float:
        self._shown[key] = value
        return value


def _decimal(value: float) -> float:
    """The least of 1, 2, 5, 10, 20 and so on that a value does not exceed."""
    power = 10.0 ** max(0, math.floor(math.log10(max(value, 1.0))))
    return next(bound for bound in (power, 2 * power, 5 * power, 10 * power) if bound >= value)


def _above(value: float, bounds: Sequence[int]) -> float:
    """The first of some bounds that a value does not exceed, or the last."""
    return next((bound for bound in bounds if bound >= value), bounds[-1])
