"""The verb `sweep`: what it prints, the files it writes, and what it refuses."""

import csv
import io
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.cli import main
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import (
    machine_from_dict,
    override,
    override_all,
    read_machine,
    write_machine,
)
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.place import solutions_at

from ..hbm.machines import random_machine

PAPER = str(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")
RPM = np.pi / 30.0
VISCOSITY = "dampers.damper_1.viscosity"
HEAVY = "unbalance.disk_2.magnitude=5.039e-4"
DISK_1 = {"unbalance.disk_2.station": "disk_1", "unbalance.disk_2.magnitude": "5.039e-4"}
OPTIONS = [word for path, value in DISK_1.items() for word in ("--set", f"{path}={value}")]

#: A rotor whose main branch has a step too small to see, 7 rpm below its hysteresis.
TINY_JUMP = {
    "name": "tiny jump",
    "materials": {
        "steel": {"youngs_modulus": 207000000000.0, "density": 7833.0, "poisson_ratio": 0.3}
    },
    "shaft": [
        {
            "elements": 20,
            "length": 0.0287974847,
            "outer_diameter": 0.031836797,
            "inner_diameter": 0.0,
            "material": "steel",
        }
    ],
    "disks": [
        {
            "name": "disk_1",
            "node": 6,
            "mass": 5.02632146,
            "polar_inertia": 0.009,
            "diametral_inertia": 0.005,
        },
        {
            "name": "disk_2",
            "node": 8,
            "mass": 3.062508,
            "polar_inertia": 0.009,
            "diametral_inertia": 0.005,
        },
        {
            "name": "disk_3",
            "node": 9,
            "mass": 4.74507501,
            "polar_inertia": 0.009,
            "diametral_inertia": 0.005,
        },
    ],
    "bearings": [{"name": "bearing_1", "node": 0, "stiffness": 105000000.0, "damping": 0.0}],
    "dampers": [
        {
            "name": "damper_1",
            "node": 20,
            "bearing_stiffness": 105000000.0,
            "bearing_damping": 0.0,
            "journal_mass": 1.52609033,
            "centering_stiffness": 637839.741,
            "diameter": 0.0762,
            "length": 0.0254,
            "clearance": 0.000187552458,
            "viscosity": 0.0284480772,
            "density": 865.0,
            "film": {"model": "short", "cavitation": True, "inertia": True},
        }
    ],
    "unbalance": [{"station": "disk_3", "magnitude": 0.000777400714, "phase": 0.0}],
    "loads": [],
    "gravity": False,
}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """One sweep with all its files."""
    folder = tmp_path_factory.mktemp("sweep")
    return folder / "curve.csv", folder / "curve.png"


def test_json_and_files(swept, capsys):
    table, picture = swept
    files = ["--output", str(table), "--picture", str(picture)]
    speeds = ["--rpm", "3900:4100", "--harmonics", "1"]
    assert main(["sweep", PAPER, *speeds, *OPTIONS, *files, "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    printed = json.loads(out)
    upper, lower = printed["folds"]
    assert upper["speed_rpm"] == pytest.approx(4012.05, abs=0.05)
    assert lower["speed_rpm"] == pytest.approx(3975.07, abs=0.05)
    assert printed["hysteresis"] == pytest.approx(upper["speed_rpm"] - lower["speed_rpm"])
    up, down = printed["jumps"]
    assert (up["direction"], down["direction"]) == ("run_up", "coast_down")
    assert up["speed_rpm"] == upper["speed_rpm"]
    assert up["eccentricity_from"] > up["eccentricity_to"] + 0.3
    assert down["eccentricity_from"] < down["eccentricity_to"] - 0.1
    assert printed["peak"]["eccentricity"] < up["eccentricity_from"] + 0.02
    assert printed["seconds"] > 0.0
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == printed["points"]
    assert float(rows[0]["speed_rpm"]) == pytest.approx(3900.0)
    assert float(rows[-1]["speed_rpm"]) == pytest.approx(4100.0)
    assert {row["stable"] for row in rows} == {"0", "1"}
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_speeds_may_be_given_either_way(capsys):
    """The response is a set of branches: A:B and B:A are one range."""
    results = []
    for speeds in ("3000:3200", "3200:3000"):
        assert main(["sweep", PAPER, "--rpm", speeds, "--harmonics", "1", "--json"]) == 0
        results.append(json.loads(capsys.readouterr().out))
    for result in results:
        del result["seconds"]
    assert results[0] == results[1]


def test_entry_of_the_machine_file_varies(capsys):
    vary = ["--vary", "dampers.damper_1.viscosity=0.02:0.05"]
    command = ["sweep", PAPER, "--rpm", "3800", "--harmonics", "1", "--json"]
    assert main([*command, *vary]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["folds"] == []
    peak = printed["peak"]
    assert peak["speed_rpm"] == pytest.approx(3800.0)
    machine = override(
        read_machine(PAPER), "dampers.damper_1.viscosity", peak["dampers.damper_1.viscosity"]
    )
    balance = HarmonicBalance(machine, Harmonics(1))
    [branch] = response_curve(balance, 3800 * RPM, 3801 * RPM).branches
    assert branch.worst_eccentricity[0] == pytest.approx(peak["eccentricity"], rel=1e-8)


def test_limits_of_an_entry_are_checked_before_anything_is_computed(capsys):
    vary = ["--vary", "materials.steel.poisson_ratio=0.1:0.6"]
    assert main(["sweep", PAPER, "--rpm", "3800", *vary]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("sfd_hbm: materials.steel.poisson_ratio must be a finite number above")
    assert err.endswith("not 0.6\n")


def test_an_end_of_a_detached_branch_has_its_reason(capsys):
    options = ["--rpm", "4100:4170", "--harmonics", "1", "--detached", "--json"]
    assert main(["sweep", PAPER, *options]) == 0
    [detached] = json.loads(capsys.readouterr().out)["detached"]
    assert detached["end"] in {stop.value for stop in Stop}


@pytest.fixture(scope="module")
def quasi_periodic(tmp_path_factory):
    """A sweep onto the quasi-periodic branch, its JSON printed and its files."""
    folder = tmp_path_factory.mktemp("sweep")
    options = ["--rpm", "3960:4145", "--harmonics", "1", "--set", HEAVY]
    files = ["--output", str(folder / "curve.csv"), "--picture", str(folder / "curve.png")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "stdout", io.StringIO())
        assert main(["sweep", PAPER, *options, *files, "--json"]) == 0
        printed = json.loads(sys.stdout.getvalue())
    return printed, folder


def test_quasi_periodic_branch(quasi_periodic):
    """It leaves at the Neimark-Sacker bifurcation and reaches the end of the range."""
    printed, folder = quasi_periodic
    [onset] = printed["instabilities"]
    [leaving] = printed["quasi_periodic"]
    assert onset["kind"] == "Neimark-Sacker"
    assert leaving["speed_rpm"] == pytest.approx([onset["speed_rpm"], 4145.0])
    assert leaving["stable_rpm"] == leaving["speed_rpm"]
    assert leaving["eccentricity"][0] == pytest.approx(onset["eccentricity"])
    assert printed["jumps"] == []
    with open(folder / "curve.csv", newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["frequency_ratio"]]
    assert float(rows[-1]["speed_rpm"]) == pytest.approx(4145.0)
    assert (folder / "curve.png").read_bytes().startswith(b"\x89PNG")


def test_detached_branches(capsys):
    """The paper's rotor has one above an eccentricity of 0.85, just below 4160 rpm."""
    options = ["--rpm", "4000:4300", "--harmonics", "1", "--detached", "--json"]
    assert main(["sweep", PAPER, *options]) == 0
    printed = json.loads(capsys.readouterr().out)
    [detached] = printed["detached"]
    assert detached["eccentricity"][0] > 0.85
    assert detached["speed_rpm"][1] == pytest.approx(4160.0, abs=5.0)


def test_selected_harmonics_lie_within_the_tolerance(tmp_path, capsys):
    """A part of the trial group is in use, and the peak is that of the whole group."""
    options = ["--rpm", "3800:3900", "--harmonics", "5", "--set", "gravity=true", "--json"]
    table = tmp_path / "curve.csv"
    assert main(["sweep", PAPER, *options, "--select", "1e-3", "--output", str(table)]) == 0
    selected = json.loads(capsys.readouterr().out)
    assert main(["sweep", PAPER, *options]) == 0
    whole = json.loads(capsys.readouterr().out)
    difference = selected["peak"]["eccentricity"] - whole["peak"]["eccentricity"]
    assert abs(difference) < 2.0 * 1e-3  # a tolerance in each of two coordinates
    with open(table, newline="", encoding="utf-8") as file:
        groups = {row["orders"] for row in csv.DictReader(file)}
    assert all(len(group.split()) < 6 for group in groups)


def test_sub_harmonics_are_let_in(tmp_path, capsys):
    """Over two revolutions there are half orders, which a circular orbit does not have."""
    table = tmp_path / "curve.csv"
    options = ["--rpm", "3000:3050", "--harmonics", "1", "--revolutions", "2"]
    assert main(["sweep", PAPER, *options, "--output", str(table), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["folds"] == []
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {"damper_1.x_1/2_cos", "damper_1.x_1_cos"} <= set(rows[0])
    assert max(abs(float(row["damper_1.x_1/2_cos"])) for row in rows) < 1e-12


def sweep(capsys, machine, *options):
    """What a sweep prints, read from JSON, and its exit status."""
    status = main(["sweep", str(machine), *options, "--json"])
    out, err = capsys.readouterr()
    return json.loads(out), status, err


def test_text_for_people(capsys):
    assert main(["sweep", PAPER, "--rpm", "3900:4100", "--harmonics", "1", *OPTIONS]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "points in" in lines[0]
    folds, jumps, widths = (
        [line for line in lines if line.startswith(word)]
        for word in ("fold ", "jump ", "hysteresis ")
    )
    assert len(folds) == len(jumps) == 2
    assert all("eccentricity of damper_1 0." in line for line in (*folds, *jumps))
    [width] = widths
    assert float(width.split()[1]) == pytest.approx(36.97, abs=0.1)
    assert width.endswith(" rpm wide")
    [greatest] = [line for line in lines if line.startswith("greatest vibration of any disk")]
    assert " zero to peak: disk_" in greatest


def test_disks_move_while_the_journal_locks(capsys):
    """As the film locks, the rotor meets its pinned critical speed."""
    read, _, _ = sweep(capsys, PAPER, "--rpm", "3900:4170", "--harmonics", "1", "--set", HEAVY)
    [down] = [one for one in read["jumps"] if one["direction"] == "coast_down"]
    assert down["eccentricity_to"] == pytest.approx(0.78, abs=0.01)
    assert down["greatest_vibration_to"]["of"] == "disk_2"
    machine = override(read_machine(PAPER), "unbalance.disk_2.magnitude", 5.039e-4)
    balance = HarmonicBalance(machine, Harmonics(1))
    curve = response_curve(balance, 3900 * RPM, 4170 * RPM)
    _, landing = next(solutions_at(curve.branches[0], down["speed_rpm"] * RPM))
    amplitudes = balance.response(landing)[1, balance.model.stations["disk_2"]]
    expected = float(np.abs(amplitudes[0]))  # a circle
    assert down["greatest_vibration_to"]["vibration"] == pytest.approx(expected, rel=1e-6)
    assert expected > 1e-3
    assert read["greatest_vibration"]["vibration"] > 10.0 * expected
    assert read["greatest_vibration"]["eccentricity"] < 1.0


def test_peaks_name_what_they_are_of(capsys):
    light = ["--set", "unbalance.disk_2.magnitude=2e-4", "--harmonics", "1"]
    read, _, _ = sweep(capsys, PAPER, "--rpm", "3300:4300", *light)
    of = [one["of"] for one in read["peaks"]]
    assert sorted(of) == ["damper_1", "disk_1", "disk_2", "disk_3"]
    assert read["peak"]["at"] == "peak"
    assert read["peak"]["damper"] == of[0] == "damper_1"
    assert read["peak"]["speed_rpm"] == read["peaks"][0]["speed_rpm"]
    assert read["amplification_factor"] == read["peaks"][0]["amplification_factor"]
    # without gravity the orbit is a circle about the centre
    assert read["peak"]["vibration"] == pytest.approx(2.54e-4 * read["peak"]["eccentricity"])


def two_dampers(folder):
    """A rotor between two different dampers, which jumps."""
    heavy = random_machine(5, dampers=2)
    changes = {
        "unbalance.disk_1.magnitude": 9e-4,
        "unbalance.disk_2.magnitude": 9e-4,
        "dampers.damper_2.viscosity": 0.005,
    }
    path = folder / "two.yaml"
    write_machine(override_all(heavy, changes), path)
    return path


def test_every_damper_is_in_a_jump(tmp_path, capsys):
    """What a jump says of each damper is what the responses beside it have."""
    machine = two_dampers(tmp_path)
    read, _, _ = sweep(capsys, machine, "--rpm", "3000:9000", "--harmonics", "1")
    assert read["jumps"]
    for jump in read["jumps"]:
        assert set(jump["dampers"]) == {"damper_1", "damper_2"}
        changes = {
            name: abs(one["eccentricity_to"] - one["eccentricity_from"])
            for name, one in jump["dampers"].items()
        }
        assert changes[jump["damper"]] == max(changes.values())
        assert jump["eccentricity_from"] == max(
            one["eccentricity_from"] for one in jump["dampers"].values()
        )
    for fold in read["folds"]:
        assert fold["eccentricity"] == fold["dampers"][fold["damper"]]["eccentricity"]
    assert main(["sweep", str(machine), "--rpm", "3000:9000", "--harmonics", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for line in lines:
        if line.startswith(("jump ", "fold ")):
            assert "of damper_1 " in line
            assert "of damper_2 " in line


def test_detached_branches_have_their_folds_and_jumps(capsys):
    """From the paper's locked rotor a machine falls back onto its run-up at either end."""
    options = ["--rpm", "4000:4300", "--harmonics", "1", "--detached"]
    read, _, _ = sweep(capsys, PAPER, *options)
    [detached] = read["detached"]
    assert read["jumps"] == []
    assert [one["direction"] for one in detached["jumps"]] == ["run_up", "coast_down"]
    for jump in detached["jumps"]:
        assert jump["eccentricity_from"] > 0.9
        assert jump["eccentricity_to"] < 0.35
    assert detached["folds"][0]["speed_rpm"] == pytest.approx(detached["jumps"][1]["speed_rpm"])
    assert main(["sweep", PAPER, *options]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("  fold ") for line in lines)
    assert sum(line.startswith("  jump ") for line in lines) == 2


def test_jumps_too_small_to_see_are_apart(tmp_path, capsys):
    """One of 0.004 of the clearance and 0.04 rpm stood for a hysteresis of 6 rpm (D6)."""
    path = tmp_path / "tiny.yaml"
    write_machine(machine_from_dict(TINY_JUMP), path)
    read, _, _ = sweep(capsys, path, "--rpm", "4200:4400", "--harmonics", "7")
    assert read["hysteresis"] == pytest.approx(6.0, abs=0.1)
    [down] = [one for one in read["jumps"] if one["direction"] == "coast_down"]
    assert down["speed_rpm"] == pytest.approx(4311.68, abs=0.05)
    for jump in read["jumps"]:
        assert abs(jump["eccentricity_to"] - jump["eccentricity_from"]) > 0.01
    assert {one["direction"] for one in read["tiny_jumps"]} == {"run_up", "coast_down"}
    for jump in read["tiny_jumps"]:
        assert abs(jump["eccentricity_to"] - jump["eccentricity_from"]) < 0.01


def test_an_entry_has_its_unit_and_no_run_up(tmp_path, capsys):
    """A jump in the unbalance at a speed between the folds."""
    vary = ["--vary", "unbalance.disk_2.magnitude=3e-4:6e-4", "--harmonics", "1"]
    assert main(["sweep", PAPER, "--rpm", "4000", *vary]) == 0
    text = capsys.readouterr().out
    assert "run-up" not in text
    assert "coast-down" not in text
    assert "amplification" not in text
    assert "upwards in unbalance.disk_2.magnitude, eccentricity of damper_1 0." in text
    assert "downwards in unbalance.disk_2.magnitude, eccentricity of damper_1 0." in text
    [width] = [line for line in text.splitlines() if line.startswith("hysteresis ")]
    assert width.endswith(" kg m wide")
    read, _, _ = sweep(capsys, PAPER, "--rpm", "4000", *vary)
    assert read["amplification_factor"] is None
    assert [one["direction"] for one in read["jumps"]] == ["upwards", "downwards"]
    assert read["varies"] == {"key": "unbalance.disk_2.magnitude", "unit": "kg m"}


def test_a_rotor_that_is_nowhere_stable_says_so(tmp_path, capsys):
    """A bearing whose cross stiffness drives the whirl faster than the film damps it."""
    matrix = "[[1.05e8, 6e7], [-6e7, 1.05e8]]"
    options = ["--rpm", "3000:3100", "--harmonics", "1", "--set"]
    read, status, err = sweep(capsys, PAPER, *options, f"bearings.bearing_1.stiffness={matrix}")
    assert status == 1
    assert err.startswith("sfd_hbm: no response in the range is stable")
    assert err.count("\n") == 1
    assert read["stable_anywhere"] is False
    assert read["peak"]["eccentricity"] is None
    assert read["points"] > 2


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--rpm", "3000"], "--rpm 3000: must be A:B with two different finite numbers"),
        (["--rpm", "3:3"], "--rpm 3:3: must be A:B with two different finite numbers"),
        (["--rpm=-3:9"], "--rpm -3: must be a finite speed above 0 rpm"),
        (["--rpm", "1:2", "--vary", "gravity=0:1"], "gravity must be a number to vary"),
        (
            ["--rpm", "1:2", "--vary", "dampers.damper_1.viscosity=1:2"],
            "--rpm 1:2: must be a sing",
        ),
        (["--rpm", "9", "--vary", "x=1:2"], "x is unknown"),
        (
            ["--rpm", "9", "--vary", f"{VISCOSITY}=0.02:0.03", "--detached"],
            "--detached: is for a range of speeds, not for --vary",
        ),
        (
            ["--rpm", "9", "--vary", f"{VISCOSITY}=0.02:0.03", "--select", "1e-3"],
            "--select: is for a range of speeds, not for --vary",
        ),
        (["--rpm", "3000:3050", "--revolutions", "0"], "revolutions: 0 is not allowed"),
        (["--rpm", "3000:3050", "--select", "0"], "tolerance: 0"),
        (
            ["--rpm", "9", "--vary", "dampers.damper_1.viscosity=1"],
            "--vary dampers.damper_1.visco",
        ),
    ],
)
def test_bad_input_is_refused(options, sentence, capsys):
    assert main(["sweep", PAPER, *options]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"sfd_hbm: {sentence}")
    assert err.count("\n") == 1


def test_machine_of_few_elements_on_a_damped_anisotropic_bearing(capsys):
    """Its shaft has no more Ritz vectors than coordinates, which once was waited for in vain."""
    machine = str(Path(__file__).parents[1] / "defects" / "D1_hang.json")
    assert main(["sweep", machine, "--rpm", "9000:10500", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["points"] >= 5
    assert printed["jumps"] == []
