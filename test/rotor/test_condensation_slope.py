"""The condensed rotor's derivatives by speed and order against sixth-order differences."""

import dataclasses

import numpy as np
import pytest

from sfd_hbm_ros.rotor import Condensation, assemble

from ..hbm.machines import PAPER, random_machine

ORDERS = np.arange(6)
STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))


def errors_against_differences(condensation, speed, slopes, step):
    """Relative errors of both slopes, order by order, (2, orders)."""
    differences = [0.0, 0.0]
    for multiple, weight in STENCIL:
        ahead, behind = (
            condensation.at(speed * (1.0 + side * multiple * step), ORDERS) for side in (1, -1)
        )
        differences[0] += weight * (ahead.stiffness - behind.stiffness)
        differences[1] += weight * (ahead.force - behind.force)
    return [
        [
            np.linalg.norm(d / (step * speed) - s) / max(np.linalg.norm(s), 1e-30)
            for d, s in zip(difference, slope, strict=True)
        ]
        for difference, slope in zip(differences, slopes, strict=True)
    ]


@pytest.mark.parametrize("speed", [137.0, 470.0, 870.0])
@pytest.mark.parametrize(
    "machine",
    [
        dataclasses.replace(PAPER, gravity=True),
        random_machine(1, anisotropic=True, gravity=True),
        random_machine(2, dampers=2, gravity=True),
    ],
    ids=["paper", "anisotropic", "two dampers"],
)
def test_slope_equals_differences(machine, speed):
    condensation = Condensation(assemble(machine))
    condensed = condensation.at(speed, ORDERS)
    slopes = condensed.stiffness_slope, condensed.force_slope
    errors = [
        errors_against_differences(condensation, speed, slopes, h) for h in (1e-3, 1e-4, 1e-5)
    ]
    # near a pole only short steps resolve an order, elsewhere the long ones round less
    assert np.max(np.min(errors, axis=0)) < 1e-7


@pytest.mark.parametrize("machine", [PAPER, random_machine(3, dampers=2)], ids=["one", "two"])
def test_slope_by_order_equals_differences(machine):
    """At orders of both signs, away from the poles."""
    condensation = Condensation(assemble(machine))
    orders, step = np.array([-2.3, -0.9, 0.4, 1.0, 2.6]), 5e-4
    difference = sum(
        side * weight * condensation.at(400.0, orders + side * multiple * step).stiffness
        for multiple, weight in STENCIL
        for side in (1, -1)
    )
    slope = condensation.slope_by_order(400.0, orders)
    errors = np.linalg.norm(difference / step - slope, axis=(1, 2))
    assert np.all(errors < 1e-7 * np.linalg.norm(slope, axis=(1, 2)))
