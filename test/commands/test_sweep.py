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
from sfd_hbm_ros.machine import override, read_machine
from sfd_hbm_ros.response.curves.curve import response_curve

PAPER = str(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")
RPM = np.pi / 30.0
VISCOSITY = "dampers.damper_1.viscosity"
HEAVY = "unbalance.disk_2.magnitude=5.039e-4"
DISK_1 = {"unbalance.disk_2.station": "disk_1", "unbalance.disk_2.magnitude": "5.039e-4"}
OPTIONS = [word for path, value in DISK_1.items() for word in ("--set", f"{path}={value}")]


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


def test_text_for_people(capsys):
    assert main(["sweep", PAPER, "--rpm", "3900:4100", "--harmonics", "1", *OPTIONS]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "points in" in lines[0]
    assert sum(line.startswith("fold ") for line in lines) == 2
    assert sum(line.startswith("jump ") for line in lines) == 2


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
