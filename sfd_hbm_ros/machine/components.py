"""The parts of a machine: shaft, disks, bearings, dampers and what acts on them.

Each field's annotation carries its rule: what it means, its unit and what it may be. The rules
hold whether a part comes from a file or from a program, and are found in the class's `rules`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from sfd_hbm_ros.machine.nested import one, reference
from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import (
    choice,
    flag,
    integer,
    label,
    number,
)
from sfd_hbm_ros.machine.vectors import Matrix2, matrix, pair

FILM_MODELS = ("short",)
"""The film models there are; "short" is the short bearing's Reynolds equation, Eq. 13."""


@dataclass(frozen=True)
class Material(Part):
    """An isotropic elastic material; its name is its key under `materials`."""

    place: ClassVar[str] = "materials.{name}"

    name: Annotated[str, label("name, the key under materials")]
    youngs_modulus: Annotated[float, number("Young's modulus", "Pa", above=0.0, usual=(1e8, 1e13))]
    density: Annotated[float, number("density", "kg/m3", above=0.0, usual=(100.0, 25e3))]
    poisson_ratio: Annotated[float, number("Poisson's ratio", above=-1.0, below=0.5)]


@dataclass(frozen=True)
class ShaftSegment(Part):
    """A run of equal, cylindrical shaft elements."""

    place: ClassVar[str] = "shaft"

    elements: Annotated[int, integer("number of elements", least=1)]
    length: Annotated[float, number("length of one element", "m", above=0.0, usual=(1e-6, 2.0))]
    outer_diameter: Annotated[float, number("outer diameter", "m", above=0.0, usual=(1e-3, 2.5))]
    inner_diameter: Annotated[
        float, number("inner diameter", "m", least=0.0, usual=(1e-4, 2.5), default=0.0)
    ]
    material: Annotated[Material, reference("material", Material)]

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.inner_diameter >= self.outer_diameter:
            limit = f"must be below the outer diameter of {self.outer_diameter} m"
            problem = f"{limit}, not {self.inner_diameter}"
            raise self.error("inner_diameter", problem, "must be below the outer diameter")


@dataclass(frozen=True)
class Station(Part):
    """A named place on the shaft."""

    name: Annotated[str, label("name of the station")]
    node: Annotated[int, integer("shaft node, counted from 0", least=0)]


@dataclass(frozen=True)
class Disk(Station):
    """A rigid disk at a node of the shaft."""

    place: ClassVar[str] = "disks.{name}"

    mass: Annotated[float, number("mass", "kg", above=0.0, usual=(1e-4, 1e5))]
    polar_inertia: Annotated[
        float, number("inertia about the shaft", "kg m2", least=0.0, usual=(1e-9, 1e5))
    ]
    diametral_inertia: Annotated[
        float, number("inertia about a diameter", "kg m2", least=0.0, usual=(1e-9, 1e5))
    ]


@dataclass(frozen=True)
class Bearing(Station):
    """A linear bearing to ground; a scalar k stands for ((k, 0), (0, k))."""

    place: ClassVar[str] = "bearings.{name}"

    stiffness: Annotated[
        Matrix2, matrix("stiffness", number("", "N/m", above=0.0, usual=(1e3, 1e13)))
    ]
    damping: Annotated[
        Matrix2, matrix("damping", number("", "N s/m", least=0.0, usual=(1e-4, 1e9)))
    ] = (
        (0.0, 0.0),
        (0.0, 0.0),
    )


@dataclass(frozen=True)
class FilmSettings(Part):
    """How the film of a damper is modelled."""

    place: ClassVar[str] = "film"

    model: Annotated[str, choice("film model", FILM_MODELS)] = "short"
    cavitation: Annotated[bool, flag("whether negative pressure is cut off")] = True
    inertia: Annotated[bool, flag("whether the fluid's temporal inertia acts")] = True


@dataclass(frozen=True)
class Damper(Station):
    """A squeeze film damper behind a ball bearing, its journal held by a centring spring."""

    place: ClassVar[str] = "dampers.{name}"

    bearing_stiffness: Annotated[
        float, number("ball bearing's stiffness", "N/m", above=0.0, usual=(1e3, 1e13))
    ]
    bearing_damping: Annotated[
        float,
        number("ball bearing's damping", "N s/m", least=0.0, usual=(1e-4, 1e9), default=0.0),
    ]
    journal_mass: Annotated[float, number("journal's mass", "kg", above=0.0, usual=(1e-4, 1e4))]
    centering_stiffness: Annotated[
        float, number("centring spring's stiffness", "N/m", least=0.0, usual=(10.0, 1e12))
    ]
    diameter: Annotated[float, number("journal's diameter", "m", above=0.0, usual=(2e-3, 2.5))]
    length: Annotated[float, number("length of the land", "m", above=0.0, usual=(2e-4, 2.0))]
    clearance: Annotated[float, number("radial clearance", "m", above=0.0, usual=(2e-6, 5e-3))]
    viscosity: Annotated[
        float, number("oil's dynamic viscosity", "Pa s", above=0.0, usual=(1e-5, 2.0))
    ]
    density: Annotated[float, number("oil's density", "kg/m3", least=0.0, usual=(100.0, 5e3))]
    film: Annotated[FilmSettings, one("film's model", FilmSettings)] = FilmSettings()

    def __post_init__(self) -> None:
        super().__post_init__()
        radius = self.diameter / 2.0
        if self.clearance >= radius:
            problem = f"must be below the journal's radius of {radius} m, not {self.clearance}"
            raise self.error("clearance", problem, "must be below the journal's radius")


@dataclass(frozen=True)
class Action(Part):
    """What acts on the shaft at a station."""

    station: Annotated[str, label("name of a disk, bearing or damper")]


@dataclass(frozen=True)
class Unbalance(Action):
    """An unbalance U at phase p, which pushes with U W^2 (cos(W t + p), sin(W t + p))."""

    place: ClassVar[str] = "unbalance.{station}"

    magnitude: Annotated[
        float, number("mass times eccentricity", "kg m", least=0.0, usual=(0.0, 10.0))
    ]
    phase: Annotated[float, number("phase", "rad", usual=(0.0, 6.3))] = 0.0


@dataclass(frozen=True)
class Load(Action):
    """A constant force on the shaft."""

    place: ClassVar[str] = "loads.{station}"

    force: Annotated[tuple[float, float], pair("force", "N")]
