"""The exception of a machine that cannot be, and how its sentence shows keys and values."""

from __future__ import annotations

import difflib
import re
import reprlib
from collections.abc import Iterable

NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")


class MachineError(ValueError):
    """A machine that cannot be, in one sentence.

    The sentence names the dotted key, what is allowed with its unit, and the value as given.

    Parameters
    ----------
    problem : str
        The sentence after the key.
    key : str
        Key of the value inside its part, or the whole dotted key where `place` is left out.
    place : str
        Dotted key of the part, such as ``dampers.damper_1``.
    """

    def __init__(self, problem: str, key: str = "", place: str = "") -> None:
        self.problem = problem
        self.key = key
        super().__init__(f"{dotted(place, key)} {problem}".strip())

    def at(self, place: str) -> MachineError:
        """Return the same error for a part at another place, which a reader knows better."""
        return MachineError(self.problem, self.key, place)


def dotted(*parts: str) -> str:
    """Join the parts of a dotted key, leaving out empty ones."""
    return ".".join(part for part in parts if part)


def show(value: object) -> str:
    """Return a value as its user wrote it, shortened where it is long or deep."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str) and NUMBER.fullmatch(value):
        return show_key(value)
    return reprlib.repr(value)


def show_key(key: object) -> str:
    """Return a key without quotes, shortened where it is long."""
    return reprlib.repr(str(key))[1:-1] or "''"


def unknown(key: object, known: Iterable[str]) -> str:
    """Say that a key is unknown, with the nearest known one and all that there are."""
    keys = list(known)
    return f"is unknown{_hint(key, keys)}; known here: {', '.join(keys) or 'nothing'}"


def not_one_of(kind: str, known: Iterable[str], value: object) -> str:
    """Say that a value is not the name of one of a kind, with the nearest and all names."""
    names = list(known)
    allowed = f"must be one of the {kind} {', '.join(names)}"
    return f"{allowed}, not {show(value)}{_hint(value, names)}"


def _hint(word: object, known: list[str]) -> str:
    """Return the question for the nearest known word, if one is near."""
    near = difflib.get_close_matches(str(word), known, n=1)
    return f" (did you mean {near[0]}?)" if near else ""
