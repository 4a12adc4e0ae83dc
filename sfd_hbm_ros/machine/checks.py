"""What the parts of a machine must fulfil together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from sfd_hbm_ros.machine.errors import MachineError, not_one_of, show

if TYPE_CHECKING:
    from sfd_hbm_ros.machine.components import Action, Station
    from sfd_hbm_ros.machine.model import Machine

MAX_ELEMENTS = 10_000
"""Enough for any rotor; a slip of the keyboard must not keep the machine busy for minutes."""


def check_machine(machine: Machine) -> None:
    """Check that the parts make a machine.

    Raises
    ------
    MachineError
        If the shaft has no or too many elements, a segment's material is not the machine's, a name
        occurs twice, a node lies off the shaft, an unbalance or a load acts at no station, or
        twice at one, or the supports stand at fewer than two nodes.
    """
    _check_shaft(machine)
    _check_names(machine)
    _check_nodes(machine)
    _check_actions(machine)
    _check_supports(machine)


def _check_shaft(machine: Machine) -> None:
    """Check the number of elements and that their materials belong to the machine."""
    elements = machine.nodes - 1
    if not 1 <= elements <= MAX_ELEMENTS:
        raise MachineError(
            f"must have 1 to {MAX_ELEMENTS} elements, not {show(elements)}", "shaft"
        )
    known = set(machine.materials)
    for index, segment in enumerate(machine.shaft):
        if segment.material not in known:
            names = [material.name for material in machine.materials]
            problem = not_one_of("machine's materials", names, segment.material.name)
            wanted = "must be one of the machine's materials"
            raise MachineError(problem, f"shaft.{index}.material", discreet=wanted)


def _check_names(machine: Machine) -> None:
    """Check that names are unique, among materials and among all stations."""
    _check_unique(("materials", material.name) for material in machine.materials)
    _check_unique(
        (section, part.name)
        for section in ("disks", "bearings", "dampers")
        for part in getattr(machine, section)
    )


def _check_nodes(machine: Machine) -> None:
    """Check that disks, bearings and dampers stand on the shaft."""
    last = machine.nodes - 1
    stations: tuple[Station, ...] = (*machine.disks, *machine.bearings, *machine.dampers)
    for part in stations:
        if part.node > last:
            problem = f"must be a node of the shaft, 0 to {last}, not {show(part.node)}"
            wanted = "must be a node of the shaft"
            raise MachineError(problem, f"{part.where}.node", discreet=wanted)


def _check_actions(machine: Machine) -> None:
    """Check that unbalances and loads act at stations, and once at each."""
    actions: tuple[Action, ...] = (*machine.unbalance, *machine.loads)
    for part in actions:
        if part.station not in machine.stations:
            problem = not_one_of("stations", machine.stations, part.station)
            wanted = "must be one of the stations"
            raise MachineError(problem, f"{part.where}.station", discreet=wanted)
    _check_unique(("unbalance", part.station) for part in machine.unbalance)
    _check_unique(("loads", part.station) for part in machine.loads)


def _check_supports(machine: Machine) -> None:
    """Check that the shaft cannot swing about a single support."""
    supports: tuple[Station, ...] = (*machine.bearings, *machine.dampers)
    nodes = {part.node for part in supports}
    if len(nodes) < 2:
        problem = f"must support the shaft at two nodes or more, not {len(nodes)}"
        raise MachineError(problem, "bearings and dampers")


def _check_unique(names: Iterable[tuple[str, str]]) -> None:
    """Check that no name occurs twice, whatever its section."""
    sections: dict[str, str] = {}
    for section, name in names:
        if name in sections:
            problem = f"must be given once, but there is {sections[name]}.{name} already"
            raise MachineError(problem, f"{section}.{name}", discreet="must be given once")
        sections[name] = section
