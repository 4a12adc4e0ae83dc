"""The solver's checks of itself: passed as it is, failed where something is wrong."""

from dataclasses import replace

import pytest

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response import self_test as module
from sfd_hbm_ros.response.self_test import Finding, self_test

from ..hbm.machines import PAPER

FORCE, ORBIT = "film force on circular orbits", "circular response of the rotor"
PEAK, JUMPS = "speed of a peak", "speeds of jumps"


def findings(machine=PAPER):
    return {finding.name: finding for finding in self_test(machine) if finding is not None}


def test_all_checks_are_passed():
    found = findings()
    assert list(found) == [FORCE, ORBIT, PEAK, JUMPS]
    assert [finding.name for finding in found.values() if not finding.passed] == []


def test_it_can_be_paused_often():
    steps = list(self_test(PAPER))
    assert len(steps) > 40


def test_a_wrong_film_fails_the_closed_form(monkeypatch):
    def thicker(damper):
        return replace(film_of(damper), viscosity=1.001 * damper.viscosity)

    monkeypatch.setattr(module, "film_of", thicker)
    finding = next(self_test(PAPER))
    assert finding.name == FORCE
    assert not finding.passed
    assert finding.deviation == pytest.approx(1e-3, rel=1e-6)


def test_another_rotor_fails_the_papers_numbers_alone():
    thinner = override_all(PAPER, {"shaft.0.outer_diameter": 0.98 * 0.0319})
    found = findings(thinner)
    assert {name for name, finding in found.items() if not finding.passed} == {PEAK, JUMPS}


def test_what_is_not_a_number_is_not_passed():
    assert not Finding("name", "source", float("nan"), 1.0, "rpm").passed
