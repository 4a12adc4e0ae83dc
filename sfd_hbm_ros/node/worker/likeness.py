"""Whether two machines are so alike that the response curve of one still tells of the other."""

from __future__ import annotations

import math
from typing import Any

from sfd_hbm_ros.machine import Machine, machine_to_dict

ALIKE = 0.02
"""Part by which numbers of two machines that count as alike may differ."""


def alike(one: Machine, other: Machine) -> bool:
    """Return whether no number of two machines differs by more than `ALIKE`, nor anything else.

    Vectors and matrices are compared by their norms, as a load is whose direction trembles.
    """
    return one == other or _alike(machine_to_dict(one), machine_to_dict(other))


def _alike(one: Any, other: Any) -> bool:
    """Compare plain data."""
    first, second = _numbers(one), _numbers(other)
    if first and second:
        limit = ALIKE * max(math.hypot(*first), math.hypot(*second))
        return len(first) == len(second) and math.dist(first, second) <= limit
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_alike(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_alike, one, other))
    return bool(one == other)


def _numbers(data: Any) -> list[float]:
    """Return the numbers of a number, a vector or a matrix; none of anything else."""
    if isinstance(data, list):
        parts = [_numbers(entry) for entry in data]
        return [x for part in parts for x in part] if all(parts) else []
    number = isinstance(data, (int, float)) and not isinstance(data, bool)
    return [float(data)] if number else []
