"""Rules of vectors and matrices in the shaft's lateral coordinates x and y."""

from __future__ import annotations

from typing import Any

from sfd_hbm_ros.machine.rules import Rule, number

_GREATEST = {"N": 1e7, "N/m": 1e13}  # of a force and a coefficient; N s/m are none greater

Matrix2 = tuple[tuple[float, float], tuple[float, float]]


def pair(about: str, unit: str) -> Rule:
    """Return the rule of a vector (x, y)."""
    component = number("", unit, usual=(0.0, _GREATEST[unit]))

    def convert(value: Any) -> tuple[float, float]:
        x, y = _sequence(value)
        return component.convert(x), component.convert(y)

    return Rule(about, f"[x, y], each {component.allowed}", convert, plain=list, unit=unit)


def interval(about: str, unit: str, *, below: float) -> Rule:
    """Return the rule of an interval [least, most], or of none: empty."""
    end = number("", unit, least=0.0, below=below)

    def convert(value: Any) -> tuple[float, ...]:
        if value is None or not _sequence(value):
            return ()
        least, most = map(end.convert, _sequence(value))
        if not least < most:
            raise ValueError
        return least, most

    allowed = f"[least, most], each {end.allowed}, the second above the first, or [] for none"
    return Rule(about, allowed, convert, plain=list)


def matrix(about: str, direct: Rule) -> Rule:
    """Return the rule of a 2x2 matrix ((xx, xy), (yx, yy)), with `direct` for xx and yy.

    A scalar k stands for ((k, 0), (0, k)).
    """
    cross = number("", "N/m or N s/m", usual=(0.0, _GREATEST["N/m"]))

    def convert(value: Any) -> Matrix2:
        if not isinstance(value, (list, tuple)):
            value = (value, 0.0), (0.0, value)
        (xx, xy), (yx, yy) = map(_sequence, value)
        return (direct.convert(xx), cross.convert(xy)), (cross.convert(yx), direct.convert(yy))

    def plain(value: Matrix2) -> float | list[list[float]]:
        (xx, xy), (yx, yy) = value
        return xx if xx == yy and xy == yx == 0.0 else [[xx, xy], [yx, yy]]

    def doubt(value: Matrix2) -> str:
        (xx, _), (_, yy) = value
        return direct.doubt(xx) or direct.doubt(yy)

    allowed = f"{direct.allowed}, or a matrix [[xx, xy], [yx, yy]] whose xx and yy are such"
    return Rule(about, allowed, convert, plain, doubt=doubt, unit=direct.unit)


def _sequence(value: object) -> list[Any] | tuple[Any, ...]:
    """Return a list or tuple; text, sets and mappings, which also unpack, are refused."""
    if not isinstance(value, (list, tuple)):
        raise TypeError
    return value
