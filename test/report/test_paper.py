"""The paper's cases as data, the claims that hold, and where a 3x can come from."""

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.hbm import stability
from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.report.paper.cases import cases_file, read_cases
from sfd_hbm_ros.report.paper.claims import JUDGES, judge
from sfd_hbm_ros.report.paper.compute import compute
from sfd_hbm_ros.report.paper.disturbed import third_harmonic
from sfd_hbm_ros.report.paper.judging import Verdict, judged, overall, undecided
from sfd_hbm_ros.report.paper.pictures import draw_figures
from sfd_hbm_ros.report.paper.study import Study
from sfd_hbm_ros.rotor import assemble

HOLDS = {
    "P1": ["alike", "order"],
    "P2": ["jumps", "range", "width_2", "order"],
    "P4": ["peak", "higher"],
    "P5": ["speed", "slow"],
    "P6": ["shape", "shrinks", "sideways"],
    "P7": ["first", "others"],
    "P8": ["factor", "above", "hardest"],
    "P9": ["speed", "above", "vanishes"],
    "P10": ["flat", "eccentric"],
    "P11": ["y"],
    "P12": ["above", "speed", "peak"],
    "P13": ["speed", "peak", "above"],
    "P14": ["speed"],
    "P15": ["most", "least"],
    "P16": ["rotor", "damper", "iterated"],
}


@pytest.fixture(scope="module")
def cases():
    return read_cases(cases_file())


@pytest.fixture(scope="module")
def study(cases):
    """All curves; the search for detached branches is left out, as it takes longest."""
    curves = {name: replace(case, detached_rpm=None) for name, case in cases.curves.items()}
    computed = dict(compute(replace(cases, curves=curves), curves))
    return Study(computed, cases.agreement, cases.criticals_rpm)


@pytest.fixture(scope="module")
def verdicts(cases, study):
    return {
        claim.name: {key: part.verdict for key, part in claim.parts.items()}
        for claim in judge(cases, study)
    }


@pytest.mark.parametrize("claim", HOLDS)
def test_claims_that_hold(verdicts, claim):
    holding = [key for key, verdict in verdicts[claim].items() if verdict is Verdict.HOLDS]
    assert holding == HOLDS[claim]


def test_the_rotor_is_at_the_threshold_of_jumping(verdicts):
    assert verdicts["P1"]["no_jump"] is verdicts["P4"]["jump"] is Verdict.OPEN


def test_a_run_up_meets_less_hysteresis_on_disks_1_and_3(verdicts):
    assert verdicts["P2"]["width_1"] is verdicts["P2"]["width_3"] is Verdict.DIFFERS


def test_the_circle_at_3990_rpm_has_no_3x(verdicts):
    assert verdicts["P3"]["third"] is Verdict.DIFFERS


def test_reasons_are_those_that_the_numbers_support(cases, study):
    """Where the same judge has other curves or speeds, its reason is another or none."""
    claim = cases.claims["P12"]
    why = JUDGES["P12"](study, claim)["below"].why
    slower, faster = map(float, re.search(r"turns between (\d+) and (\d+) rpm", why).groups())
    for rpm, first in ((slower, True), (faster, False)):
        row = study.amplitudes(claim.curves, rpm)
        assert (row[0] == max(row)) is first
    before = replace(claim, numbers={**claim.numbers, "below_rpm": [slower]})
    assert JUDGES["P12"](study, before)["below"].why == ""
    claim = cases.claims["P8"]
    assert "plateau rather than a resonance" in JUDGES["P8"](study, claim)["speed"].why
    stiff = JUDGES["P8"](study, replace(claim, curves=claim.curves[-2:]))["speed"]
    assert (stiff.verdict, stiff.why) == (Verdict.HOLDS, "")
    claim = cases.claims["P5"]
    assert "what the peak adds" in JUDGES["P5"](study, claim)["amplitude"].why
    backwards = replace(claim, curves=claim.curves[::-1])
    assert JUDGES["P5"](study, backwards)["amplitude"].why == ""


def test_a_disturbance_makes_a_3x_that_dies_out(study):
    """It dies out as the leading multiplier says: the orbit is elliptic until it is a circle."""
    balance = study.curve("u504_disk_2").balance
    solution = study.start_up("u504_disk_2", 3990.0)
    early, late = third_harmonic(balance, solution, 0.03, (5, 60))
    leading = abs(stability(balance, solution).multipliers[0])
    assert early > 1e-4
    assert late / early == pytest.approx(leading**60, rel=0.1)


@pytest.mark.parametrize(("angles", "third"), [(2, True), (3, False), (4, True), (5, False)])
def test_a_film_over_few_fixed_angles_makes_a_3x(study, angles, third):
    """Pressure clipped at n angles is n-fold symmetric: orders 1 + m n of x + i y."""
    solution = study.start_up("u504_disk_2", 3990.0)
    balance, [motion] = study.curve("u504_disk_2").balance, solution.journals.values()
    turn = 2.0 * np.pi * np.arange(256) / 256
    x, v, a = (motion.at(turn, order) * solution.speed**order for order in (0, 1, 2))
    phi = 2.0 * np.pi * np.arange(angles) / angles
    n = np.stack([np.cos(phi), np.sin(phi)])
    film = film_of(balance.machine.dampers[0])
    h = film.clearance - x @ n
    pressure = 12.0 * film.viscosity * (v @ n) / h**3 + film.density * (a @ n) / h  # Eq. 13
    force = -(np.maximum(pressure, 0.0) @ n.T)
    spectrum = np.linalg.norm(np.fft.rfft(force, axis=0), axis=1)
    assert (spectrum[3] > 0.01 * spectrum[1]) == third
    exact = np.linalg.norm(np.fft.rfft(film.force(x, v, a), axis=0), axis=1)
    assert exact[3] < 1e-9 * exact[1]


def test_figures_are_written(cases, study, tmp_path):
    files = draw_figures(cases, study, tmp_path / "new")
    assert [path.name for path in files] == [f"fig{n:02}.png" for n in range(4, 20)]
    for path in files:
        assert imread(path)[..., :3].std() > 0.05  # not blank


def test_cases_are_complete(cases):
    assert list(cases.figures) == list(range(4, 20))
    assert list(cases.claims) == list(JUDGES) == [f"P{i}" for i in range(1, 17)]
    used = {name for claim in cases.claims.values() for name in claim.curves}
    drawn = {name for figure in cases.figures.values() for name in figure.curves.values()}
    assert used | drawn == set(cases.curves)


def test_loads_are_multiples_of_the_weight_of_shaft_and_disks(cases):
    loaded = assemble(cases.curves["gravity"].machine)
    weight = -loaded.static_force[: loaded.shaft_size].sum()
    for times in (1, 2, 4, 8, 16):
        [load] = cases.curves[f"load_{times}"].machine.loads
        assert load.force == (0.0, pytest.approx(-times * weight, rel=1e-4))


def test_springs_and_inertias_are_those_of_the_paper(cases):
    lbf_per_inch = 4.4482216152605 / 0.0254
    for stiffness in (100, 1500, 2500, 10_000):
        [damper] = cases.curves[f"spring_{stiffness}"].machine.dampers
        assert damper.centering_stiffness == pytest.approx(stiffness * lbf_per_inch, rel=1e-4)
    for disk in range(3):
        for times in (2, 4, 8, 16):
            machine = cases.curves[f"disk_{disk + 1}_inertia_{times}"].machine
            expected = [9.3e-3 * (times if other == disk else 1) for other in range(3)]
            assert [one.polar_inertia for one in machine.disks] == pytest.approx(expected)


def test_a_change_that_does_not_fit_is_refused_by_its_curve(tmp_path):
    text = cases_file().read_text().replace("{gravity: true}}", "{gravitation: true}}", 1)
    (tmp_path / "cases.yaml").write_text(text)
    machine = cases_file().with_name("paper_rotor.yaml")
    (tmp_path / machine.name).write_text(machine.read_text())
    with pytest.raises(MachineError, match=r"curves\.gravity: gravitation is unknown"):
        read_cases(tmp_path / "cases.yaml")


def test_a_claim_holds_where_all_its_parts_do():
    holds, differs, open_ = judged(True, ""), judged(False, ""), undecided("", "")
    assert overall([holds, holds]) is Verdict.HOLDS
    assert overall([holds, open_]) is Verdict.OPEN
    assert overall([open_, differs, holds]) is Verdict.DIFFERS
