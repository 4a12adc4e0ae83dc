"""All responses at one speed against the closed form of circular orbits."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.coexisting import coexisting_solutions

from ...hbm.machines import PAPER, random_machine
from ...hbm.test_circular_orbit import PI_FILM, circular_orbits
from ...hbm.test_continuation import heavier
from ...hbm.test_uncondensed import uncondensed_residual

RPM = np.pi / 30.0


@pytest.mark.parametrize(
    ("machine", "speed"),
    [
        (override_all(PAPER, {"unbalance.disk_2.magnitude": 5.039e-4}), 4000.0 * RPM),
        (override_all(PAPER, {"unbalance.disk_2.magnitude": 5.039e-4}), 4120.0 * RPM),
        (PAPER, 4150.0 * RPM),
        (PAPER, 3700.0 * RPM),
        (heavier(random_machine(612, film=PI_FILM), 2.0), 600.0),
    ],
    ids=["4000", "4120", "detached", "one", "random"],
)
def test_every_circular_orbit_is_found(machine, speed):
    balance = HarmonicBalance(machine, Harmonics(1))
    known = solve(balance, speed)
    others = coexisting_solutions(balance, speed, known)
    found = sorted(one.eccentricity_max for one in (known, *others))
    expected = [e for e, _ in circular_orbits(machine, balance.model, speed)]
    assert [e for e in found if e < 0.98] == pytest.approx(
        [e for e in expected if e < 0.98], abs=1e-7
    )


def test_others_are_solutions_and_each_is_there_once():
    """With gravity, where orbits are no circles; the known one may be any of them."""
    changes = {"unbalance.disk_2.magnitude": 5.039e-4, "gravity": True}
    balance = HarmonicBalance(override_all(PAPER, changes), Harmonics(5))
    speed = 4050.0 * RPM
    known = solve(balance, speed)
    others = coexisting_solutions(balance, speed, known)
    assert len(others) >= 2
    for one in others:
        assert uncondensed_residual(balance, one) < 1e-8
    again = coexisting_solutions(balance, speed, others[-1])
    assert sorted(one.eccentricity_max for one in (*again, others[-1])) == pytest.approx(
        sorted(one.eccentricity_max for one in (*others, known)), abs=1e-6
    )
