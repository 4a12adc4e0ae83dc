"""Peaks of the vibration: where they are, how high and how sharp, whatever the range."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.quasi_periodic_response import standing_response
from sfd_hbm_ros.machine import (
    Bearing,
    Damper,
    Disk,
    Machine,
    ShaftSegment,
    Unbalance,
    override_all,
)
from sfd_hbm_ros.response.curves.curve import parameter_curve, response_curve
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.responses import disk_vibrations, vibration, with_unknowns
from sfd_hbm_ros.rotor import critical_speeds, hold_journals
from sfd_hbm_ros.rotor.directions import Direction

from ...hbm.machines import PAPER, STEEL, isotropic, random_machine

RPM = np.pi / 30.0
UNBALANCE = "unbalance.disk_2.magnitude"


def summarised(machine, lowest, highest, harmonics=1):
    balance = HarmonicBalance(machine, Harmonics(harmonics))
    return Summary(response_curve(balance, lowest * RPM, highest * RPM))


@cache
def light(gravity):
    """The paper's rotor with 200 g mm, which does not jump."""
    machine = override_all(PAPER, {UNBALANCE: 2e-4, "gravity": gravity})
    return summarised(machine, 3200, 4500, 1 if not gravity else 5)


def overhung():
    """A heavy disk that hangs over a bearing on a soft damper, which sags under its weight."""
    return Machine(
        name="overhung",
        materials=(STEEL,),
        shaft=(ShaftSegment(8, 0.06, 0.035, 0.0, STEEL),),
        disks=(Disk("fan", 8, 6.0, 0.03, 0.016),),
        bearings=(Bearing("rear", 0, isotropic(1e8)),),
        dampers=(Damper("front", 6, 1e8, 0.0, 0.8, 1.5e6, 0.0762, 0.0254, 2.0e-4, 0.02, 865.0),),
        unbalance=(Unbalance("fan", 4e-5),),
        gravity=True,
    )


def swept_vibration(machine, harmonics, speeds):
    """Vibration of every damper of a journal at speeds [rpm] that are solved one by one."""
    balance = HarmonicBalance(machine, Harmonics(harmonics))
    solution, found = None, []
    for rpm in speeds:
        solution = solve(balance, rpm * RPM, start=solution)
        found.append([vibration(solution, name) for name in solution.journals])
    return np.array(found)


@pytest.mark.parametrize(
    "machine",
    [
        override_all(PAPER, {UNBALANCE: 2e-4}),
        override_all(PAPER, {UNBALANCE: 1e-4, "dampers.damper_1.centering_stiffness": 1e6}),
        override_all(random_machine(4), {"unbalance.disk_1.magnitude": 1e-5}),
    ],
    ids=["paper", "soft", "random"],
)
def test_peak_speeds_do_not_depend_on_the_range(machine):
    """To a tenth of a rpm, and those of all ranges that hold them."""
    ranges = [(1000, 8000), (1200, 7000), (2500, 6500), (3000, 6100)]
    found = [
        [(one.of, one.value / RPM) for one in summarised(machine, *ends).peaks] for ends in ranges
    ]
    inside = [
        {(of, rpm) for of, rpm in one if ranges[-1][0] < rpm < ranges[-1][1]} for one in found
    ]
    first, *others = (sorted(one) for one in inside)
    assert first
    for other in others:
        assert [of for of, _ in other] == [of for of, _ in first]
        assert [rpm for _, rpm in other] == pytest.approx([rpm for _, rpm in first], abs=0.1)


def test_peak_is_the_greatest_vibration_nearby():
    [peak] = light(False).peaks
    machine = light(False).curve.balance.machine
    speeds = peak.value / RPM + np.linspace(-2.0, 2.0, 41)
    heights = swept_vibration(machine, 1, speeds)[:, 0]
    assert abs(speeds[heights.argmax()] - peak.value / RPM) <= 0.1
    assert peak.vibration == pytest.approx(heights.max(), rel=1e-7)
    assert light(False).peak.value == peak.value


def test_shallow_peaks_between_distant_points_are_found():
    """A small unbalance makes the continuation stride over them in a wide range."""
    machine = random_machine(5, dampers=2)
    small = replace(
        machine,
        unbalance=tuple(replace(one, magnitude=0.05 * one.magnitude) for one in machine.unbalance),
    )
    wide, narrow = (summarised(small, *ends, 3).peaks for ends in ((500, 20000), (500, 12000)))
    assert len(narrow) == 3
    assert [one.value for one in wide] == pytest.approx(
        [one.value for one in narrow], abs=0.1 * RPM
    )


def test_amplification_factor_is_of_the_vibration():
    """Comparable with and without gravity, and as a dense sweep of it has it (API 684)."""
    for summary in (light(False), light(True)):
        [peak] = summary.peaks
        factor = peak.amplification_factor
        speeds = np.arange(3300.0, 4300.0, 2.0)
        curve = summary.curve
        heights = swept_vibration(curve.balance.machine, curve.harmonics.highest, speeds)[:, 0]
        above = speeds[heights > heights.max() / np.sqrt(2.0)]
        assert factor == pytest.approx(peak.value / RPM / (above[-1] - above[0]), rel=0.02)
    without, with_gravity = (light(gravity).amplification_factor for gravity in (False, True))
    assert with_gravity == pytest.approx(without, rel=0.05)


def test_an_overhung_rotor_reports_its_critical_speed_and_not_its_sag():
    summary = summarised(overhung(), 500, 6000, 5)
    model = summary.curve.balance.model
    free, held = (
        next(one.speed for one in critical_speeds(rotor) if one.direction is Direction.FORWARD)
        for rotor in (model, hold_journals(model))
    )
    sag = summary.curve.branches[0].solutions[0].eccentricity_max
    assert summary.peak.vibration < 0.2 * sag
    assert free < summary.peak.value < held  # the film stiffens what the springs hold
    [fan] = [one for one in summary.disk_peaks if one.value < held]
    assert fan.of == "fan"
    assert fan.value == pytest.approx(summary.peak.value, rel=0.05)


def test_peaks_of_disks_are_those_of_the_whole_rotor():
    summary = light(True)
    peaks = summary.disk_peaks
    assert {one.of for one in peaks} == {"disk_1", "disk_2", "disk_3"}
    balance = summary.curve.balance
    for peak in peaks:
        near = [
            disk_vibrations(balance, solve(balance, peak.value + shift, peak.response))[peak.of]
            for shift in (-0.1 * RPM, 0.0, 0.1 * RPM)
        ]
        assert near[0] < near[1] > near[2]
        assert peak.vibration == pytest.approx(near[1], rel=1e-7)


def test_disks_of_a_quasi_periodic_response_move_as_in_time():
    """One that stands is the circle; else the whirls of all frequencies are what is summed up."""
    balance = HarmonicBalance(PAPER, Harmonics(1))
    circle = solve(balance, 3800.0 * RPM)
    standing = standing_response(circle, Harmonics(3), 150.0)
    assert disk_vibrations(balance, standing) == pytest.approx(disk_vibrations(balance, circle))
    rows = standing.coefficients.copy()
    rows[1:5] += 1e-5 * np.array([[1.0, 0.2], [0.3, -0.5], [0.1, 0.4], [-0.2, 0.6]])
    moving = with_unknowns(standing, None, np.append(rows, standing.frequency))
    orders = 1.0 + np.arange(-3, 4) * moving.frequency_ratio
    journals = np.outer(moving.whirl("damper_1"), [1.0, -1.0j])
    amplitudes = balance.condensation.at(moving.speed, orders).recover(journals)
    time = np.linspace(0.0, 2.0 * np.pi / moving.frequency, 4001)
    waves = np.exp(1j * moving.speed * np.multiply.outer(time, orders))
    for name, found in disk_vibrations(balance, moving).items():
        x, y = (waves @ amplitudes[:, balance.model.stations[name]]).real.T
        assert found == pytest.approx(np.hypot(x, y).max(), rel=1e-4)


def test_nothing_is_amplified_by_an_entry_of_the_machine_file():
    path = "dampers.damper_1.centering_stiffness"
    balance = HarmonicBalance(override_all(PAPER, {UNBALANCE: 2e-4}), Harmonics(1))
    summary = Summary(parameter_curve(balance, 3790.0 * RPM, path, 1.5e6, 4e6))
    [peak] = summary.peaks
    assert summary.amplification_factor is peak.amplification_factor is None
    assert summary.peak.value == peak.value
    heights = [
        solve(
            HarmonicBalance(override_all(balance.machine, {path: one}), Harmonics(1)), 3790 * RPM
        ).eccentricity_max
        for one in (0.999 * peak.value, peak.value, 1.001 * peak.value)
    ]
    assert heights[0] < heights[1] > heights[2]


def test_without_a_peak_the_greatest_vibration_is_at_an_end():
    summary = summarised(override_all(PAPER, {UNBALANCE: 2e-4}), 3000, 3300)
    assert summary.peaks == []
    assert summary.amplification_factor is None
    assert summary.peak.value / RPM == pytest.approx(3300.0)
