"""Parts of a machine: dataclasses that check themselves, read from and turned into plain data."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar, get_type_hints

from sfd_hbm_ros.machine.errors import MachineError, dotted, show, show_key, unknown
from sfd_hbm_ros.machine.rules import REQUIRED, MeaninglessError, Rule

P = TypeVar("P", bound="Part")


@dataclass(frozen=True)
class Part:
    """A part of a machine, each of whose fields obeys its rule from construction on.

    Raises
    ------
    MachineError
        If a field breaks its rule.
    """

    place: ClassVar[str] = ""
    """Dotted key of such a part, into which its fields are formatted."""

    rules: ClassVar[Mapping[str, Rule]] = {}
    """The rule of each field, in the fields' order."""

    def __init_subclass__(cls) -> None:
        hints = get_type_hints(cls, include_extras=True)
        cls.rules = {
            key: rule for key, hint in hints.items() for rule in getattr(hint, "__metadata__", ())
        }

    def __post_init__(self) -> None:
        for key, rule in self.rules.items():
            value = getattr(self, key)
            try:
                converted = rule.convert(value)
            except MeaninglessError as error:
                raise self.error(key, f"{error}, not {show(value)}") from None
            except (ValueError, TypeError, OverflowError):
                allowed = f"must be {rule.allowed}"
                raise self.error(key, f"{allowed}, not {show(value)}", allowed) from None
            object.__setattr__(self, key, converted)

    @property
    def where(self) -> str:
        """Dotted key of the part in a machine file, as far as its own fields tell."""
        return self.place.format(**vars(self))

    def error(self, key: str, problem: str, discreet: str = "") -> MachineError:
        """Return the error of one of the part's own keys, see `MachineError`."""
        return MachineError(problem, key, self.where, discreet)


def plain(part: Part) -> dict[str, Any]:
    """Return a part as plain data: mappings, lists, text, numbers and booleans."""
    return {key: rule.plain(getattr(part, key)) for key, rule in part.rules.items()}


def doubts(part: Part, place: str = "") -> Iterator[str]:
    """Return sentences on numbers that are allowed, but not of a size that machines have.

    Each begins with the dotted key; most likely the number is in another unit.
    """
    for key, rule in part.rules.items():
        value = getattr(part, key)
        if isinstance(value, tuple) and value and isinstance(value[0], Part):
            for index, item in enumerate(value):
                label = getattr(item, "name", getattr(item, "station", index))
                yield from doubts(item, dotted(place, key, str(label)))
        elif words := rule.doubt(value):
            yield f"{dotted(place, key)} {words}"


def read(
    kind: type[P], data: object, place: str, materials: Any = MappingProxyType({}), **given: object
) -> P:
    """Return the part that plain data describe.

    Parameters
    ----------
    kind : type
        The dataclass to make.
    data : mapping
        The file's data.
    place : str
        Dotted key of the data.
    materials : mapping of str to Material
        What the part may refer to, by name.
    **given
        Fields that stand elsewhere than among the data.

    Raises
    ------
    MachineError
        If a key is unknown or missing, or a value is not allowed.
    """
    expected = {key: rule for key, rule in kind.rules.items() if key not in given}
    entries = _known_keys(data, expected, place)
    values = _defaults(kind) | given
    for key, rule in expected.items():
        if key in entries:
            # A segment's material is one of the machine's, whose rule comes before the shaft's.
            if "materials" in values:
                materials = {part.name: part for part in values["materials"]}
            values[key] = rule.read(entries[key], dotted(place, key), materials)
        elif key not in values:
            raise MachineError(f"is missing: {rule.about}, {rule.allowed}", key, place)
    try:
        return kind(**values)
    except MachineError as error:
        raise error.at(place) from None


def _known_keys(data: object, expected: Collection[str], place: str) -> Mapping[str, Any]:
    """Return the data if they are a mapping that has no other keys than those expected."""
    if not isinstance(data, Mapping):
        keys = ", ".join(expected)
        allowed = f"must be a mapping with the keys {keys}"
        problem = f"{allowed}, not {show(data)}"
        raise MachineError(problem, place or "the machine", discreet=allowed)
    for key in data:
        if key not in expected and not place and not any(known in data for known in expected):
            # It may be any file, whose first words are none of the reader's business.
            discreet = f"is no machine file: it has none of the keys {', '.join(expected)}"
            raise MachineError(f"{show_key(key)} {unknown(key, expected)}", discreet=discreet)
        if key not in expected:
            raise MachineError(unknown(key, expected), show_key(key), place)
    return data


def _defaults(kind: type[Part]) -> dict[str, Any]:
    """Return what a part has for the keys that a file may leave out."""
    return {
        field.name: default
        for field in fields(kind)
        for default in (field.default, kind.rules[field.name].default)
        if default is not MISSING and default is not REQUIRED
    }
