"""What several topics say under one stamp, brought together."""

from collections.abc import Set
from typing import Any


class Joining:
    """Collects the parts of every stamp until they are complete.

    Parameters
    ----------
    wanted : set of str
        Names of the parts.
    limit : int
        Incomplete stamps kept; beyond it the oldest are forgotten.
    """

    def __init__(self, wanted: Set[str], limit: int = 1000) -> None:
        self._wanted = wanted
        self._limit = limit
        self._parts: dict[int, dict[str, Any]] = {}

    def add(self, stamp: int, name: str, part: object) -> dict[str, Any] | None:
        """Add a part and return all parts of its stamp if it was the last one missing."""
        parts = self._parts.setdefault(stamp, {})
        parts[name] = part
        if parts.keys() == self._wanted:
            return self._parts.pop(stamp)
        if len(self._parts) > self._limit:
            del self._parts[next(iter(self._parts))]
        return None
