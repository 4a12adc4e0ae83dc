"""What a single value of a machine may be: one rule a field, from which all else follows.

A rule stands in the field's annotation, ``mass: Annotated[float, number("mass", "kg", above=0)]``.
It reads, checks and converts what a file or a caller gives, turns it back into plain data, and
words what is allowed for errors, documents and parameter descriptions.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection
from dataclasses import dataclass
from numbers import Real
from typing import Any

from sfd_hbm_ros.machine.errors import NUMBER

REQUIRED = object()
BEYOND = 1e6
"""Multiple of the greatest size that machines have from which on a number means nothing."""

OTHER_UNITS = {
    "m": {"mm": 1e-3, "um": 1e-6},
    "kg": {"g": 1e-3},
    "kg m": {"g mm": 1e-6, "kg mm": 1e-3},
    "kg m2": {"kg mm2": 1e-6},
    "kg/m3": {"g/cm3": 1e3},
    "N/m": {"N/mm": 1e3, "N/um": 1e6},
    "N s/m": {"N s/mm": 1e3},
    "Pa": {"GPa": 1e9, "MPa": 1e6},
    "Pa s": {"mPa s": 1e-3},
    "rad": {"deg": math.pi / 180.0},
}
"""Units that data sheets and drawings have, in SI: what may have been meant by an odd number."""

NAME = re.compile(r"(?=.{1,64}$)[\w-]+( [\w-]+)*")


class MeaninglessError(ValueError):
    """A number that can mean nothing; the sentence is what it must be."""


@dataclass(frozen=True)
class Rule:
    """What a field means and may hold.

    Parameters
    ----------
    about : str
        What the field is, for people.
    allowed : str
        What it may hold, with its unit, as it follows "must be".
    convert : callable
        Returns a given value as the field's type; raises ValueError, TypeError or OverflowError
        if it is not allowed.
    plain : callable
        Returns the field's value as a file holds it.
    read : callable
        Returns what `convert` takes from a file's data, the data's dotted key, and the materials
        read so far. Only parts inside parts need it.
    default : object
        What a file means by leaving the key out, where the dataclass cannot have a default
        because fields without one follow.
    doubt : callable
        Returns what is odd about a value that is allowed, as it follows the key; '' if nothing is.
    unit : str
        SI unit of a number, or of those of a vector or matrix; '' where it has none.
    """

    about: str
    allowed: str
    convert: Callable[[Any], Any]
    plain: Callable[[Any], Any] = lambda value: value
    read: Callable[[Any, str, Any], Any] = lambda data, key, materials: data
    default: object = REQUIRED
    doubt: Callable[[Any], str] = lambda value: ""
    unit: str = ""


def number(
    about: str,
    unit: str = "",
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    below: float = math.inf,
    usual: tuple[float, float] | None = None,
    default: object = REQUIRED,
) -> Rule:
    """Return the rule of a real number with above < number < below and number >= least.

    A size outside of `usual`, from the least to the greatest that machines have, is allowed and
    doubted: most likely it is in another unit. Zero means that there is no such thing. A size
    greater than that by `BEYOND`, which no unit explains, is refused.
    """
    limits = {"above": above, "of at least": least, "below": below}
    allowed = f"a finite number [{unit}]" if unit else "a finite number"
    words = " and ".join(f"{word} {x:g}" for word, x in limits.items() if math.isfinite(x))

    def convert(value: Any) -> float:
        x = _to_float(value)
        # NaN and the infinities lie in no open interval, not even the unlimited one.
        if not (above < x < below and x >= least):
            raise ValueError
        most = BEYOND * usual[1] if usual else math.inf
        if abs(x) > most:
            limit = f"at most {most:g}" if x > 0.0 else f"at least {-most:g}"
            raise MeaninglessError(f"must be {limit} [{unit}], a million times what is usual")
        return x

    def doubt(x: float) -> str:
        least_usual, most_usual = usual or (0.0, math.inf)
        if x == 0.0 or least_usual <= abs(x) <= most_usual:
            return ""
        for other, factor in OTHER_UNITS.get(unit, {}).items():
            meant = abs(x) * factor
            if least_usual <= meant <= most_usual:
                question = f"were {x:g} {other} meant, which are {x * factor:g} {unit}?"
                break
        else:
            question = "is it in that unit?"
        return f"is {x:g} {unit}, where {least_usual:g} to {most_usual:g} are usual: {question}"

    return Rule(
        about, f"{allowed} {words}".rstrip(), convert, default=default, doubt=doubt, unit=unit
    )


def integer(about: str, *, least: int) -> Rule:
    """Return the rule of an integer; 24.0 is one, since other programs write it so."""

    def convert(value: Any) -> int:
        x = _to_float(value)
        if not (x.is_integer() and x >= least):
            raise ValueError
        return int(x)

    return Rule(about, f"an integer of at least {least}", convert)


def flag(about: str) -> Rule:
    """Return the rule of a switch, in any of the words that YAML 1.1 knows."""
    words = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}

    def convert(value: Any) -> bool:
        word = str(value).lower() if isinstance(value, (bool, str)) else ""
        if word not in words:
            raise ValueError
        return words[word]

    return Rule(about, "true or false", convert)


def label(about: str) -> Rule:
    """Return the rule of a name; it has no dot, because dots join names to paths."""
    allowed = "a name of at most 64 letters, digits, _ and -, with single spaces between"
    return Rule(about, allowed, lambda value: _text_if(value, NAME.fullmatch))


def title(about: str, *, default: object) -> Rule:
    """Return the rule of one line of text, which may be empty."""

    def convert(value: Any) -> str:
        return _text_if(value, str.isprintable)

    return Rule(about, "one line of text", convert, default=default)


def choice(about: str, options: Collection[str]) -> Rule:
    """Return the rule of a word out of several."""
    allowed = f"one of: {', '.join(options)}"
    return Rule(about, allowed, lambda value: _text_if(value, options.__contains__))


def _to_float(value: object) -> float:
    """Return a number, or text that reads as one, as a float; a boolean is neither."""
    if isinstance(value, str) and NUMBER.fullmatch(value):
        return float(value)
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    raise ValueError


def _text_if(value: object, holds: Callable[[str], object]) -> str:
    """Return text for which the condition holds."""
    if not (isinstance(value, str) and holds(value)):
        raise ValueError
    return value
