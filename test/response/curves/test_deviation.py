"""How far machines lie from a curve, held against their own curves."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import Load, Machine, override, override_all, read_machine
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.deviation import HOLDS, deviation, landmarks

from ...node.process import PAPER_ROTOR

HEAVY = override_all(read_machine(PAPER_ROTOR), {"unbalance.disk_2.magnitude": 5.039e-4})
LOADED = replace(HEAVY, loads=(Load("disk_3", (0.0, -200.0)),))


@cache
def curve(machine: Machine) -> ResponseCurve:
    return response_curve(HarmonicBalance(machine, Harmonics(3)), 390.0, 450.0)


def apart(machine: Machine, other: Machine) -> float:
    return deviation(HarmonicBalance(other, Harmonics(3)), landmarks(curve(machine)))


def loaded(*force: float) -> Machine:
    return replace(HEAVY, loads=(Load("disk_3", force),))


@pytest.mark.parametrize(
    "other",
    [
        LOADED,
        loaded(0.3, -200.1),
        loaded(0.0, -230.0),  # three times 5 %
        replace(LOADED, loads=(*LOADED.loads, Load("disk_1", (0.0, 0.0)))),
        override(LOADED, "unbalance.disk_2.phase", 0.001),
        override(LOADED, "dampers.damper_1.viscosity", 1.05 * 0.028),
    ],
)
def test_a_curve_holds_for_other_numbers_with_the_same_responses(other):
    assert apart(LOADED, other) <= HOLDS


@pytest.mark.parametrize(
    "other",
    [
        HEAVY,
        loaded(0.0, -400.0),
        override(LOADED, "gravity", True),
        override(LOADED, "unbalance.disk_2.magnitude", 1.05 * 5.039e-4),
        override(LOADED, "unbalance.disk_2.magnitude", 2.0e-4),
        override(LOADED, "dampers.damper_1.centering_stiffness", 1.2 * 2.627e6),
        override(LOADED, "dampers.damper_1.viscosity", 1.3 * 0.028),
    ],
)
def test_it_does_not_where_responses_are_others(other):
    assert apart(LOADED, other) > HOLDS


def test_a_fold_that_moves_is_measured_by_how_far_it_does():
    """Its own speed is a tenth of the unit, so that the fold's shift is told within a tenth."""
    other = override(LOADED, "dampers.damper_1.centering_stiffness", 1.02 * 2.627e6)
    [before], [after] = (
        [
            (branch.solutions[i], branch.values[i])
            for branch in curve(machine).branches
            for i in np.flatnonzero(branch.fold)
        ]
        for machine in (LOADED, other)
    )
    moved = abs(after[1] / before[1] - 1.0)
    assert moved > 5e-4
    found = deviation(HarmonicBalance(other, Harmonics(3)), [before[0]])
    assert found == pytest.approx(10.0 * moved, rel=0.2)


def test_other_harmonics_are_not_compared():
    assert deviation(HarmonicBalance(HEAVY, Harmonics(1)), landmarks(curve(LOADED))) == np.inf
