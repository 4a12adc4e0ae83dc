"""Machines that the harmonic balance is tried on."""

from pathlib import Path

import numpy as np

from sfd_hbm_ros.machine import (
    Bearing,
    Damper,
    Disk,
    FilmSettings,
    Load,
    Machine,
    Material,
    ShaftSegment,
    Unbalance,
    read_machine,
)

PAPER = read_machine(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")
#: Changes of the paper's rotor after which nothing lifts its journal off the damper's wall.
UNBEARABLE = {
    "gravity": True,
    "unbalance.disk_2.magnitude": 0.0,
    "dampers.damper_1.centering_stiffness": 2e4,
}
STEEL = Material("steel", 2.07e11, 7833.0, 0.3)

DEFAULT_FILM = FilmSettings()


def isotropic(value):
    return ((value, 0.0), (0.0, value))


def damper(rng, name, node, film):
    """A damper near the paper's."""
    return Damper(
        name=name,
        node=node,
        bearing_stiffness=1e8 * rng.uniform(0.5, 2.0),
        bearing_damping=rng.uniform(0.0, 100.0),
        journal_mass=rng.uniform(0.3, 2.0),
        centering_stiffness=10.0 ** rng.uniform(5.5, 7.0),
        diameter=0.0762 * rng.uniform(0.8, 1.2),
        length=0.0254 * rng.uniform(0.8, 1.2),
        clearance=2.54e-4 * rng.uniform(0.6, 1.4),
        viscosity=0.028 * rng.uniform(0.5, 2.0),
        density=865.0,
        film=film,
    )


def random_machine(
    seed, film=DEFAULT_FILM, dampers=1, anisotropic=False, gravity=False, elements=None
):
    """A rotor of random size with two disks, on one bearing and one damper or on two dampers."""
    rng = np.random.default_rng(seed)
    elements = elements or int(rng.integers(6, 13))
    first, second = sorted(rng.choice(np.arange(1, elements), 2, replace=False).tolist())
    stiffness = 1e8 * rng.uniform(0.3, 1.5)
    matrix = ((stiffness, 0.0), (0.0, 0.6 * stiffness)) if anisotropic else isotropic(stiffness)
    places = [elements, 0][:dampers]
    return Machine(
        name=f"random machine {seed}",
        materials=(STEEL,),
        shaft=(ShaftSegment(elements, 0.6 / elements, rng.uniform(0.028, 0.04), 0.0, STEEL),),
        disks=tuple(
            Disk(
                name, node, rng.uniform(2.0, 6.0), rng.uniform(5e-3, 2e-2), rng.uniform(3e-3, 1e-2)
            )
            for name, node in (("disk_1", first), ("disk_2", second))
        ),
        bearings=(Bearing("bearing_1", 0, matrix, isotropic(0.0)),) if dampers == 1 else (),
        dampers=tuple(damper(rng, f"damper_{i}", node, film) for i, node in enumerate(places, 1)),
        unbalance=(
            Unbalance("disk_1", 4e-4 * rng.uniform(0.3, 1.0), rng.uniform(-3.0, 3.0)),
            Unbalance("disk_2", 4e-4 * rng.uniform(0.3, 1.0), rng.uniform(-3.0, 3.0)),
        ),
        loads=(Load("disk_1", (30.0, -50.0)),) if gravity else (),
        gravity=gravity,
    )


def misaligned_rotor():
    """A stiff rotor on a light damper, off centre by 0.4 of its clearance under a side load.

    Its unbalance is large. At about three to four times its critical speed of 2800 rpm only a
    response is stable that repeats after two revolutions, as Zhao, Linnett and McLean 1994,
    J. Vibration and Acoustics 116, 357, found for rigid rotors above twice their critical speed.
    """
    return Machine(
        name="stiff rotor on a misaligned damper",
        materials=(STEEL,),
        shaft=(ShaftSegment(2, 0.15, 0.04, 0.0, STEEL),),
        disks=(Disk("disk", 1, 4.0, 9e-3, 5e-3),),
        bearings=(Bearing("bearing", 0, isotropic(1e8), isotropic(0.0)),),
        dampers=(
            Damper(
                name="damper",
                node=2,
                bearing_stiffness=1e8,
                bearing_damping=0.0,
                journal_mass=1.0,
                centering_stiffness=2.6e5,
                diameter=0.0762,
                length=0.0127,
                clearance=2.54e-4,
                viscosity=0.02,
                density=865.0,
                film=FilmSettings(inertia=False),
            ),
        ),
        unbalance=(Unbalance("disk", 5.7e-4, 0.0),),
        loads=(Load("disk", (0.0, -53.0)),),
        gravity=False,
    )


def rigid_rotor(unbalance, film, mass=10.0, natural=100.0, clearance=1e-4):
    """A stiff rotor between two equal dampers with springs, whose response is in closed form.

    Taylor and Kumar 1980, Cookson and Kossa 1979: with the natural frequency `natural` [rad/s] of
    its `mass` [kg] on the springs, the speed over it W, the `unbalance` u = U/(mass clearance) and
    the `film` b = mu R L^3/(mass clearance^3 natural) of both dampers, a circular orbit of
    eccentricity e fulfils `rigid_balance`.
    """
    radius, length, journal = 0.05, 0.02, 0.01
    shaft = ShaftSegment(2, 0.1, 0.1, 0.0, Material("stiff", 1e13, 100.0, 0.3))
    shaft_mass = 0.2 * np.pi / 4 * 0.1**2 * 100.0
    return Machine(
        name="rigid rotor on two dampers",
        materials=(shaft.material,),
        shaft=(shaft,),
        disks=(Disk("disk", 1, mass - 2.0 * journal - shaft_mass, 0.05, 0.03),),
        bearings=(),
        dampers=tuple(
            Damper(
                name=f"damper_{node}",
                node=node,
                bearing_stiffness=1e9,
                bearing_damping=0.0,
                journal_mass=journal,
                centering_stiffness=mass * natural**2 / 2.0,
                diameter=2.0 * radius,
                length=length,
                clearance=clearance,
                viscosity=0.5 * film * mass * clearance**3 * natural / (radius * length**3),
                density=0.0,
                film=FilmSettings(inertia=False),
            )
            for node in (0, 2)
        ),
        unbalance=(Unbalance("disk", unbalance * mass * clearance),),
    )


def rigid_balance(unbalance, film, speed, eccentricity):
    """How far a circular orbit of a rigid rotor is from balance, of the unbalance's force.

    All are as in `rigid_rotor`, the speed over the natural frequency.
    """
    s = 1.0 - eccentricity**2
    radial = 1.0 - speed**2 + 2.0 * film * speed * eccentricity / s**2
    tangential = 0.5 * np.pi * film * speed / s**1.5
    return eccentricity * np.hypot(radial, tangential) / (unbalance * speed**2) - 1.0
