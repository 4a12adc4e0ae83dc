"""The exception of a machine that cannot be, and how its sentence shows keys and values."""

from __future__ import annotations

import difflib
import re
import reprlib
from collections.abc import Iterable

_LONGEST_WORD = 200  # that is meant for a key

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
    discreet : str
        The problem without anything that a file holds, where that is not the same.
    """

    def __init__(self, problem: str, key: str = "", place: str = "", discreet: str = "") -> None:
        self.problem = problem
        self.key = key
        self._place = place
        self._discreet = discreet or problem
        super().__init__(f"{dotted(place, key)} {problem}".strip())

    def at(self, place: str) -> MachineError:
        """Return the same error for a part at another place, which a reader knows better."""
        return MachineError(self.problem, self.key, place, self._discreet)

    def of(self, path: object) -> MachineError:
        """Return the same error, whose sentence begins with a file's path."""
        discreet = f"{path}: {self.discreet()}"
        return MachineError(f"{path}: {self}", discreet=discreet)

    def discreet(self) -> str:
        """Return the sentence for those who may not see what a file holds but for its keys."""
        return f"{dotted(self._place, self.key)} {self._discreet}".strip()


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
    return f"is unknown{hint(key, keys)}; known here: {', '.join(keys) or 'nothing'}"


def not_one_of(kind: str, known: Iterable[str], value: object) -> str:
    """Say that a value is not the name of one of a kind, with the nearest and all names."""
    names = list(known)
    allowed = f"must be one of the {kind} {', '.join(names)}"
    return f"{allowed}, not {show(value)}{hint(value, names)}"


def hint(word: object, known: Iterable[str]) -> str:
    """Return the question for the nearest known word, if one is near."""
    if len(str(word)) > _LONGEST_WORD:
        return ""  # the search takes long for a long word
    near = difflib.get_close_matches(str(word), list(known), n=1)
    return f" (did you mean {near[0]}?)" if near else ""
