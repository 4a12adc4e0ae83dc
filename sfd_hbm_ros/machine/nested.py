"""Rules of fields that hold other parts, or refer to one by its name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

from sfd_hbm_ros.machine.errors import MachineError, dotted, not_one_of, show, show_key
from sfd_hbm_ros.machine.parts import Part, plain, read
from sfd_hbm_ros.machine.rules import NAME, REQUIRED, Rule

Parts = tuple[Part, ...]


def one(about: str, kind: type[Part]) -> Rule:
    """Return the rule of a field that holds a part: in a file, a mapping."""

    def from_data(data: Any, key: str, materials: Any) -> Part:
        return read(kind, {} if data is None else data, key, materials)

    return Rule(about, f"a {kind.__name__}", _instance_of(kind), plain, from_data)


def many(about: str, kind: type[Part], *, least: int = 0, default: object = REQUIRED) -> Rule:
    """Return the rule of a field that holds several parts: in a file, a list of mappings.

    A key without a value is an empty list: its items may all be commented out. The file must have
    at least so many; what a program may leave out is for `check_machine` to say.
    """
    allowed = f"a list of {least} or more {kind.__name__}"

    def from_data(data: Any, key: str, materials: Any) -> Parts:
        items = [] if data is None else data
        if not isinstance(items, (list, tuple)):
            wanted = "must be a list of mappings"
            raise MachineError(f"{wanted}, not {show(items)}", key, discreet=wanted)
        if len(items) < least:
            wanted = f"must be {allowed}"
            raise MachineError(f"{wanted}, not {show(items)}", key, discreet=wanted)
        return tuple(
            read(kind, item, dotted(key, item_label(item, index)), materials)
            for index, item in enumerate(items)
        )

    def to_data(parts: Parts) -> list[dict[str, Any]]:
        return [plain(part) for part in parts]

    return Rule(about, allowed, _several(kind), to_data, from_data, default)


def table(about: str, kind: type[Part]) -> Rule:
    """Return the rule of a field that holds one or more parts: in a file, a mapping of names."""
    allowed = f"a mapping of 1 or more names to a {kind.__name__}"

    def from_data(data: Any, key: str, materials: Any) -> Parts:
        items = {} if data is None else data
        if not (isinstance(items, Mapping) and items):
            wanted = f"must be {allowed}"
            raise MachineError(f"{wanted}, not {show(items)}", key, discreet=wanted)
        return tuple(
            read(kind, item, dotted(key, show_key(name)), name=name)
            for name, item in items.items()
        )

    def to_data(parts: Parts) -> dict[str, Any]:
        items = [plain(part) for part in parts]
        return {item.pop("name"): item for item in items}

    return Rule(about, allowed, _several(kind), to_data, from_data)


def reference(about: str, kind: type[Part]) -> Rule:
    """Return the rule of a field that holds one of the materials: in a file, its name."""

    def from_data(data: Any, key: str, materials: Any) -> Part:
        if not (isinstance(data, str) and data in materials):
            wanted = "must be one of the materials"
            raise MachineError(not_one_of("materials", materials, data), key, discreet=wanted)
        return cast(Part, materials[data])

    def to_data(part: Any) -> str:
        return str(part.name)

    return Rule(about, f"a {kind.__name__}", _instance_of(kind), to_data, from_data)


def item_label(item: object, index: int) -> str:
    """Return the name or the station of a list's item, or its index where it has neither."""
    for key in ("name", "station"):
        label = item.get(key) if isinstance(item, Mapping) else None
        if isinstance(label, str) and NAME.fullmatch(label):
            return label
    return str(index)


def _instance_of(kind: type[Part]) -> Callable[[Any], Part]:
    """Return a converter that lets pass what is of a kind."""

    def convert(value: Any) -> Part:
        if not isinstance(value, kind):
            raise TypeError
        return value

    return convert


def _several(kind: type[Part]) -> Callable[[Any], Parts]:
    """Return a converter to a tuple of what is of a kind."""
    convert_one = _instance_of(kind)
    return lambda values: tuple(convert_one(value) for value in values)
