"""The solver's checks of itself: passed as it is, failed where something is wrong."""

from dataclasses import replace

import pytest

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.report.paper.cases import (
    cases_file,
    published_jumps,
    published_peak,
    read_cases,
)
from sfd_hbm_ros.response import self_test as module
from sfd_hbm_ros.response.self_test import Finding, self_test

from ..hbm.machines import PAPER

FORCE, ORBIT = "film force on circular orbits", "circular response of the rotor"
PEAK, JUMPS, WIDTH = "speed of a peak", "speeds of jumps", "width of a hysteresis"
CASES = read_cases(cases_file())
PUBLISHED = published_peak(CASES), published_jumps(CASES)


def findings(machine=PAPER, published=PUBLISHED):
    found = self_test(machine, *published)
    return {finding.name: finding for finding in found if finding is not None}


def test_all_checks_are_passed():
    found = findings()
    assert list(found) == [FORCE, ORBIT, PEAK, JUMPS, WIDTH]
    assert [finding.name for finding in found.values() if not finding.passed] == []


def test_it_can_be_paused_often():
    steps = list(self_test(PAPER, *PUBLISHED))
    assert len(steps) > 40


def test_a_wrong_film_fails_the_closed_form(monkeypatch):
    def thicker(damper):
        return replace(film_of(damper), viscosity=1.001 * damper.viscosity)

    monkeypatch.setattr(module, "film_of", thicker)
    finding = next(self_test(PAPER, *PUBLISHED))
    assert finding.name == FORCE
    assert not finding.passed
    assert finding.deviation == pytest.approx(1e-3, rel=1e-6)


def test_another_rotor_fails_the_papers_numbers_alone():
    """It is followed over the same range as the paper's, and found to respond elsewhere in it."""
    changed = {"shaft.0.outer_diameter": 0.96 * 0.0319}
    thinner = [replace(one, machine=override_all(one.machine, changed)) for one in PUBLISHED]
    found = findings(override_all(PAPER, changed), thinner)
    assert {name for name, one in found.items() if not one.passed} >= {PEAK, JUMPS}
    assert found[FORCE].passed
    assert found[ORBIT].passed
    assert 0.02 < found[PEAK].deviation < 0.1  # a peak was found, and lies lower


@pytest.mark.parametrize("times", [0.9, 1.1])
def test_other_numbers_of_the_paper_would_fail(times):
    """What is expected comes from the cases as data, and so does where it is looked for."""
    peak, jumps = PUBLISHED
    least, most = (times * rpm for rpm in jumps.between_rpm)
    other = (
        replace(peak, rpm=times * peak.rpm),
        replace(jumps, between_rpm=(least, most), width_rpm=times**2 * jumps.width_rpm),
    )
    found = findings(published=other)
    failed = {name for name, one in found.items() if not one.passed}
    assert {PEAK, JUMPS} <= failed
    assert f"{times * peak.rpm:g} rpm" in found[PEAK].source


def test_a_response_that_does_not_jump_is_not_passed():
    peak, jumps = PUBLISHED
    light = override_all(jumps.machine, {"unbalance.disk_2.magnitude": 1e-4})
    found = findings(published=(peak, replace(jumps, machine=light)))
    assert {name for name, one in found.items() if not one.passed} == {JUMPS, WIDTH}


def test_what_is_not_a_number_is_not_passed():
    assert not Finding("name", "source", float("nan"), 1.0, "rpm").passed
