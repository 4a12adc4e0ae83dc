"""The machine's unbalances as parameters, in two ways that always agree.

`unbalance.STATION.magnitude` and `unbalance.STATION.phase` are those of one station, and there are
some for every station of the machine. `unbalance.stations`, `unbalance.magnitudes` and
`unbalance.phases` list what there is anywhere: who sets the lists sets all unbalances at once.
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor

from sfd_hbm_ros.machine import Machine, Unbalance
from sfd_hbm_ros.machine.errors import not_one_of, show
from sfd_hbm_ros.node.schema import ParameterError

Values = Mapping[str, Any]

STATIONS, MAGNITUDES, PHASES = LISTS = tuple(
    f"unbalance.{key}" for key in ("stations", "magnitudes", "phases")
)


MOST = 10_000
"""Items of a list that is too long; no machine has as many stations."""


@dataclass(frozen=True)
class ListSpec:
    """What a list parameter means and may be, as `Spec` for a single value.

    Parameters
    ----------
    name, about, unit : str
        Its name, what it is, and the unit of its numbers.
    kind : type
        Of its items, str or float.
    """

    name: str
    about: str
    kind: type
    unit: str = ""

    @property
    def allowed(self) -> str:
        """What it may be, in words."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"a list of {'names' if self.kind is str else 'numbers'}{unit}"

    @property
    def descriptor(self) -> ParameterDescriptor:
        """What ROS tools show of it; rclpy takes an empty list for one of another type."""
        about = f"{self.about}: {self.allowed}"
        return ParameterDescriptor(description=about, dynamic_typing=True)

    def convert(self, value: object) -> list[Any]:
        """Return a value as a list of its kind: integers are numbers too.

        Raises
        ------
        ParameterError
            If it is no list, or an item is of another kind.
        """
        items = list(value[:MOST]) if isinstance(value, (list, tuple, array)) else [None]
        taken = [float(one) if self.kind is float and type(one) is int else one for one in items]
        if any(type(one) is not self.kind for one in taken) or len(items) == MOST:
            raise ParameterError(f"{self.name} must be {self.allowed}, not {show(value)}")
        return taken


LIST_SCHEMA = (
    ListSpec(STATIONS, "stations with an unbalance; with the other lists they are all", str),
    ListSpec(MAGNITUDES, "mass times eccentricity at each of these", float, "kg m"),
    ListSpec(PHASES, "phase at each of these, 0 where it is not given with them", float, "rad"),
)


def everywhere(machine: Machine) -> Machine:
    """Return the machine with an unbalance at every station, of 0 where there was none."""
    there = {one.station: one for one in machine.unbalance}
    unbalance = (there.get(name, Unbalance(name, 0.0)) for name in machine.stations)
    return replace(machine, unbalance=tuple(unbalance))


def listed(values: Values) -> dict[str, Any]:
    """Return the lists for the values of single stations, those without any left out."""
    keys = "magnitude", "phase"
    there = [one for one in _stations(values) if any(values[_name(one, key)] for key in keys)]
    return {
        STATIONS: there,
        MAGNITUDES: [values[_name(one, "magnitude")] for one in there],
        PHASES: [values[_name(one, "phase")] for one in there],
    }


def agreed(given: Values, known: Values) -> dict[str, Any]:
    """Return values that are to be set, together with what they mean for the other way.

    Parameters
    ----------
    given : mapping of str to object
        The values that are to be set, by the names of any parameters.
    known : mapping of str to object
        The present values, of other parameters too.

    Raises
    ------
    ParameterError
        If lists do not go together, name no station or one twice, or if both ways do not agree.
    """
    known = {name: value for name, value in known.items() if name.startswith("unbalance.")}
    lists = [name for name in given if name in LISTS]
    single = [name for name in given if name in known and name not in LISTS]
    if not lists:
        return {**given, **listed({**known, **given})} if single else dict(given)
    values = {**given, **_from_lists(given, known)}
    for name in single:
        if given[name] != values[name]:
            says = f"as the lists of unbalances say, not {show(given[name])}"
            raise ParameterError(f"{name} must be {values[name]} {says}")
    return values


def _from_lists(given: Values, known: Values) -> dict[str, Any]:
    """Return the lists, complete, and the values of every station."""
    stations, magnitudes = (given.get(name, known[name]) for name in (STATIONS, MAGNITUDES))
    phases = given.get(PHASES, [0.0] * len(stations) if STATIONS in given else known[PHASES])
    names = _stations(known)
    for i, station in enumerate(stations):
        if station not in names:
            raise ParameterError(f"{STATIONS}[{i}] {not_one_of('stations', names, station)}")
        if station in stations[:i]:
            raise ParameterError(f"{STATIONS} must not hold {station} twice")
    for name, numbers in ((MAGNITUDES, magnitudes), (PHASES, phases)):
        if len(numbers) != len(stations):
            raise ParameterError(
                f"{name} must hold {len(stations)} numbers, one for each of {STATIONS}, not "
                f"{len(numbers)}; they can be set together by set_parameters_atomically"
            )
    values: dict[str, Any] = {name: 0.0 for name in known if name not in LISTS}
    for station, magnitude, phase in zip(stations, magnitudes, phases, strict=True):
        values[_name(station, "magnitude")], values[_name(station, "phase")] = magnitude, phase
    return {**values, STATIONS: stations, MAGNITUDES: magnitudes, PHASES: phases}


def _stations(values: Values) -> list[str]:
    """Return the stations that have values of their own."""
    return [name.split(".")[1] for name in values if name.endswith(".magnitude")]


def _name(station: str, key: str) -> str:
    return f"unbalance.{station}.{key}"
