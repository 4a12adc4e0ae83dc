"""A response followed to another machine, against closed-form orbits, and what work it takes."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Equations, HarmonicBalance, solve
from sfd_hbm_ros.machine import get, override
from sfd_hbm_ros.response.tracking.following import follow
from sfd_hbm_ros.response.tracking.way import Way

from ...hbm.test_circular_orbit import circular_orbits
from .test_tracker import LOWEST, RPM, balance

VISCOSITY, UNBALANCE = "dampers.damper_1.viscosity", "unbalance.disk_1.magnitude"
STEADY = 3930.0  # rpm, on the steep flank of the resonance


@dataclass(frozen=True)
class CountedWay(Way):
    """A way that tells at which parts of it the machine was balanced."""

    parts: list[float] = field(default_factory=list)

    def at(self, part: float) -> Equations:
        self.parts.append(part)
        return super().at(part)


def upper(rpm: float) -> np.ndarray:
    """Coefficients of the response that a run-up meets."""
    known = None
    for speed in np.linspace(LOWEST, rpm, 20) * RPM:
        known = solve(balance(), speed, known)
    return known.unknowns


def way_to(path: str, factor: float, rpm: float) -> CountedWay:
    """The way to another value of the machine and from 3930 rpm to another speed."""
    value = factor * float(get(balance().machine, path))
    end = HarmonicBalance(override(balance().machine, path, value), balance().harmonics)
    return CountedWay(balance(), STEADY * RPM, end, rpm * RPM)


@pytest.mark.parametrize(
    ("path", "factor", "rpm", "most"),
    [
        (VISCOSITY, 1.05, STEADY, 3),
        (VISCOSITY, 1.05, STEADY + 5.0, 6),
        (UNBALANCE, 1.02, STEADY, 3),
        (UNBALANCE, 1.2, STEADY, 12),
        (UNBALANCE, 0.8, STEADY, 24),
    ],
)
def test_changed_machine_is_reached_in_few_strides(path, factor, rpm, most):
    way = way_to(path, factor, rpm)
    found = follow(way, upper(STEADY))
    assert found.part == 1.0
    orbits = circular_orbits(way.end.machine, way.end.model, rpm * RPM)
    below = max(e for e, _ in orbits if e < 0.85)
    assert found.solution.eccentricity_max == pytest.approx(below, abs=1e-8)
    assert found.solution.residual <= 1e-10
    assert len(way.parts) <= most


def test_way_without_a_change_needs_no_other_machine():
    way = CountedWay(balance(), STEADY * RPM, balance(), (STEADY + 1.0) * RPM)
    found = follow(way, upper(STEADY))
    assert (found.part, way.parts) == (1.0, [0.0, 1.0])
    assert way.at(0.5).balance is balance()


def test_response_that_ends_on_the_way_is_followed_to_its_fold():
    """With three quarters of the unbalance there is no upper orbit at 3998 rpm any more."""
    way = CountedWay(balance(), 3998.0 * RPM, way_to(UNBALANCE, 0.75, 0.0).end, 3998.0 * RPM)
    found = follow(way, upper(3998.0))
    assert 0.0 < found.part < 1.0
    before, after = found.part - 0.03, found.part + 0.03
    counts = []
    for part in (before, after):
        at = way.at(part).balance
        stable = [e for e, _ in circular_orbits(at.machine, at.model, 3998.0 * RPM) if e < 0.85]
        counts.append(len(stable))
    assert counts == [3, 1]
