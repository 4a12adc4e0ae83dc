"""Any entry of a machine by its dotted path, such as ``dampers.damper_1.centering_stiffness``.

The items of a list go by their name, unbalances and loads by their station, and what has neither
by its index: ``shaft.0.length``, ``loads.disk_3.force.1``. Every station has an unbalance, of 0
where the machine has none: ``unbalance.bearing_1.magnitude``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sfd_hbm_ros.machine.components import Unbalance
from sfd_hbm_ros.machine.errors import MachineError, dotted, show_key, unknown
from sfd_hbm_ros.machine.files import machine_from_dict, machine_to_dict
from sfd_hbm_ros.machine.model import Machine
from sfd_hbm_ros.machine.nested import item_label
from sfd_hbm_ros.machine.parts import Part, plain


def get(machine: Machine, path: str) -> Any:
    """Return an entry of a machine as it stands in a machine file.

    Raises
    ------
    MachineError
        If there is no such entry; the sentence says which there are.
    """
    data = machine_to_dict(machine)
    data["unbalance"] += _zero_unbalances(machine, path)
    container, key = _find(data, path)
    return container[key]


def unit_of(machine: Machine, path: str) -> str:
    """Return the SI unit of an entry of a machine by its dotted path; '' where it has none.

    Raises
    ------
    MachineError
        If there is no such entry; the sentence says which there are.
    """
    get(machine, path)  # says what there is
    unbalances = [*machine.unbalance, *(Unbalance(name, 0.0) for name in machine.stations)]
    entry: Any = machine
    unit = ""
    for label in path.split("."):
        if isinstance(entry, Part):
            unit, entry = entry.rules[label].unit, getattr(entry, label)
            entry = unbalances if label == "unbalance" else entry
        elif not unit:  # of parts; what has a unit is a vector or a matrix
            labels = [item_label(vars(one), index) for index, one in enumerate(entry)]
            entry = entry[labels.index(label)]
    return unit


def override(machine: Machine, path: str, value: Any) -> Machine:
    """Return the machine with one entry changed, to a value as a machine file might hold it.

    Raises
    ------
    MachineError
        If there is no such entry, or the machine cannot be with that value.
    """
    return override_all(machine, {path: value})


def override_all(machine: Machine, changes: Mapping[str, Any]) -> Machine:
    """Return the machine with several entries changed at once, by their dotted paths.

    Paths are those of the machine as it is. Only the outcome is checked, so that entries which
    belong together may change together.

    Raises
    ------
    MachineError
        If there is no such entry, or the machine cannot be with these values.
    """
    data = machine_to_dict(machine)
    data["unbalance"] += _zero_unbalances(machine, *changes)
    places = [(_find(data, path), value) for path, value in changes.items()]
    for (container, key), value in places:
        container[key] = value
    none = _zero_unbalances(machine, *changes)
    if none and "unbalance" not in changes:
        data["unbalance"] = [one for one in data["unbalance"] if one not in none]
    return machine_from_dict(data)


def _zero_unbalances(machine: Machine, *paths: str) -> list[dict[str, Any]]:
    """Return what a machine file would have at stations without unbalance, if paths name one."""
    if not any(path.startswith("unbalance.") for path in paths):
        return []
    present = {one.station for one in machine.unbalance}
    absent = (station for station in machine.stations if station not in present)
    return [plain(Unbalance(station, 0.0)) for station in absent]


def _find(data: Any, path: str) -> tuple[Any, Any]:
    """Return the mapping or list that holds the entry at a path, and its key or index there."""
    *parents, last = path.split(".")
    place = ""
    for label in parents:
        data = data[_key(data, label, place)]
        place = dotted(place, label)
    return data, _key(data, last, place)


def _key(entry: Any, label: str, place: str) -> Any:
    """Return the key or the index that a label means in a mapping or a list."""
    keys: dict[str, Any] = {}
    if isinstance(entry, Mapping):
        keys = {key: key for key in entry}
    elif isinstance(entry, list):
        keys = {item_label(item, index): index for index, item in enumerate(entry)}
    if label not in keys:
        raise MachineError(unknown(label, keys), dotted(place, show_key(label)))
    return keys[label]
