"""Machines that several tests share."""

from pathlib import Path

import numpy as np

from sfd_hbm_ros.machine import (
    Bearing,
    Damper,
    Disk,
    Load,
    Machine,
    Material,
    ShaftSegment,
    Unbalance,
    read_machine,
)

RPM = np.pi / 30.0  # rad/s
STEEL = Material("steel", youngs_modulus=2.11e11, density=7810.0, poisson_ratio=0.3)


def paper_rotor():
    return read_machine(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")


def rotor(*, shaft, bearings=(), disks=(), dampers=(), **actions):
    materials = {segment.material.name: segment.material for segment in shaft}
    return Machine(
        name="",
        materials=tuple(materials.values()),
        shaft=shaft,
        disks=disks,
        bearings=bearings,
        dampers=dampers,
        **actions,
    )


def beam(elements, length, diameter, stiffness, material=STEEL, **actions):
    """A uniform shaft on two equal bearings at its ends."""
    return rotor(
        shaft=(ShaftSegment(elements, length / elements, diameter, 0.0, material),),
        bearings=(Bearing("left", 0, stiffness), Bearing("right", elements, stiffness)),
        **actions,
    )


def disk(name, node, diameter, width, bore=0.05, density=7810.0):
    """A disk of the given dimensions [m], with its inertias as a hollow cylinder."""
    mass = density * width * np.pi / 4.0 * (diameter**2 - bore**2)
    radii = (diameter**2 + bore**2) / 4.0
    return Disk(name, node, mass, mass * radii / 2.0, mass * (radii / 4.0 + width**2 / 12.0))


def damper(name, node, **changes):
    values = {
        "bearing_stiffness": 1.05e8,
        "bearing_damping": 0.0,
        "journal_mass": 1.5,
        "centering_stiffness": 2.6e6,
        "diameter": 0.0762,
        "length": 0.0254,
        "clearance": 2.54e-4,
        "viscosity": 0.028,
        "density": 865.0,
    }
    return Damper(name, node, **{**values, **changes})


def rich_rotor(bearing_stiffness, bearing_damping):
    """A stepped, partly hollow shaft with two dampers, one of them between the disks."""
    brass = Material("brass", youngs_modulus=1.05e11, density=8500.0, poisson_ratio=0.34)
    return rotor(
        shaft=(
            ShaftSegment(3, 0.06, 0.03, 0.0, STEEL),
            ShaftSegment(4, 0.04, 0.045, 0.02, brass),
            ShaftSegment(2, 0.08, 0.025, 0.005, STEEL),
        ),
        disks=(disk("fan", 2, 0.2, 0.02), disk("turbine", 6, 0.25, 0.03)),
        bearings=(Bearing("thrust", 0, bearing_stiffness, bearing_damping),),
        dampers=(
            damper("middle", 4, bearing_damping=150.0),
            damper("end", 9, centering_stiffness=9e5, journal_mass=0.7),
        ),
        unbalance=(Unbalance("fan", 3e-4, 0.4), Unbalance("turbine", 5e-4, -2.0)),
        loads=(Load("turbine", (40.0, -90.0)), Load("end", (-5.0, 3.0))),
        gravity=True,
    )
