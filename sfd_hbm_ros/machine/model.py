"""The whole machine that a user describes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated

from sfd_hbm_ros.machine.checks import check_machine
from sfd_hbm_ros.machine.components import (
    Bearing,
    Damper,
    Disk,
    Load,
    Material,
    ShaftSegment,
    Station,
    Unbalance,
)
from sfd_hbm_ros.machine.nested import many, table
from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import flag, title
from sfd_hbm_ros.machine.vectors import interval


@dataclass(frozen=True)
class Machine(Part):
    """A rotor on bearings and squeeze film dampers; without dampers it is a linear rotor.

    Raises
    ------
    MachineError
        If a part breaks its rule, or the parts do not make a machine: see `check_machine`.
    """

    name: Annotated[str, title("title", default="")]
    materials: Annotated[tuple[Material, ...], table("materials by name", Material)]
    shaft: Annotated[tuple[ShaftSegment, ...], many("segments from node 0", ShaftSegment, least=1)]
    disks: Annotated[tuple[Disk, ...], many("disks", Disk, default=())]
    bearings: Annotated[tuple[Bearing, ...], many("bearings to ground", Bearing, default=())]
    dampers: Annotated[tuple[Damper, ...], many("squeeze film dampers", Damper, default=())]
    unbalance: Annotated[tuple[Unbalance, ...], many("unbalances", Unbalance)] = ()
    loads: Annotated[tuple[Load, ...], many("constant forces", Load)] = ()
    gravity: Annotated[bool, flag("whether gravity acts, 9.80665 m/s2 along -y")] = False
    operating_speed_rpm: Annotated[
        tuple[float, ...], interval("range of the speeds at which it runs", "rpm", below=9e5)
    ] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        check_machine(self)

    @property
    def nodes(self) -> int:
        """Number of shaft nodes."""
        return sum(segment.elements for segment in self.shaft) + 1

    @property
    def stations(self) -> Mapping[str, int]:
        """Node of every disk, bearing and damper by its name."""
        parts: tuple[Station, ...] = (*self.disks, *self.bearings, *self.dampers)
        return MappingProxyType({part.name: part.node for part in parts})
