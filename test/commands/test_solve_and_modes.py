"""The command line in a process of its own: results, refusals and exit statuses."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, override_all, read_machine
from sfd_hbm_ros.rotor import assemble

from .studies import without_progress

ROOT = Path(__file__).parents[2]
PAPER = str(ROOT / "config" / "paper_rotor.yaml")


def run(*arguments):
    command = [sys.executable, "-m", "sfd_hbm_ros", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
    done.stderr = without_progress(done.stderr)
    return done


def test_solve_prints_what_the_library_computes():
    done = run(
        "solve", PAPER, "--rpm", "3900", "--set", "gravity=true", "--harmonics", "5", "--json"
    )
    assert (done.returncode, done.stderr) == (0, "")
    printed = json.loads(done.stdout)
    balance = HarmonicBalance(override(read_machine(PAPER), "gravity", True), Harmonics(5))
    solution = solve(balance, 3900.0 * np.pi / 30.0)
    motion = solution.journals["damper_1"]
    assert list(printed) == [
        "speed_rpm",
        "converged",
        "residual",
        "iterations",
        "stable",
        "harmonics",
        "truncation_error",
        "dampers",
        "greatest_vibration",
        "sag",
        "others",
    ]
    assert printed["speed_rpm"] == pytest.approx(3900.0, rel=1e-15)
    assert printed["converged"] is True
    assert printed["harmonics"] == 5
    assert 1e-6 < printed["truncation_error"] < 1e-5
    assert printed["stable"] is True
    damper = printed["dampers"]["damper_1"]
    assert damper["orders"] == [0, 1, 2, 3, 4, 5]
    assert damper["eccentricity_max"] == pytest.approx(motion.eccentricity_max, rel=1e-9)
    assert damper["eccentricity_mean"] == pytest.approx(motion.eccentricity_mean, rel=1e-9)
    rows = [damper[key] for key in ("x_cos", "y_cos", "x_sin", "y_sin")]
    expected = [*motion.cos.T, *motion.sin.T]
    assert np.allclose(rows, expected, rtol=1e-7, atol=1e-14)


def test_solve_takes_the_harmonics_that_it_needs_and_says_what_they_leave_out():
    soft = ("--set", "gravity=true", "--set", "dampers.damper_1.centering_stiffness=2.627e5")
    chosen = run("solve", PAPER, "--rpm", "2000", *soft, "--json")
    fixed = run("solve", PAPER, "--rpm", "2000", *soft, "--harmonics", "7", "--json")
    printed, seven = json.loads(chosen.stdout), json.loads(fixed.stdout)
    assert seven["harmonics"] == 7 < printed["harmonics"]
    assert printed["truncation_error"] <= 1e-5 < seven["truncation_error"]
    orders = printed["dampers"]["damper_1"]["orders"]
    assert orders == list(range(printed["harmonics"] + 1))
    told = run("solve", PAPER, "--rpm", "2000", *soft, "--harmonics", "7").stdout
    assert "7 harmonics; more would add 2e-05 of the clearance, so more of them are needed" in told


def test_solve_for_people_is_a_table():
    done = run("solve", PAPER, "--rpm", "3900")
    assert done.returncode == 0
    assert "3900 rpm: stable response" in done.stdout
    assert "damper_1: eccentricity max 0.6896" in done.stdout
    assert "-0.0000" not in done.stdout


def test_no_solution_is_status_1_and_one_sentence():
    """Without unbalance nothing lifts the journal, and the soft spring cannot."""
    changes = {
        "unbalance.disk_2.magnitude": "0",
        "gravity": "true",
        "dampers.damper_1.centering_stiffness": "2e4",
    }
    options = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
    done = run("solve", PAPER, "--rpm", "3000", "--json", *options)
    assert done.returncode == 1
    assert done.stderr.startswith("sfd_hbm: no solution at 3000 rpm: the load could not be raised")
    assert done.stderr.count("\n") == 1
    printed = json.loads(done.stdout)
    assert printed["converged"] is False
    assert printed["stable"] is None
    assert printed["dampers"]["damper_1"]["eccentricity_max"] is None


HEAVY = ["--harmonics", "1", "--set", "unbalance.disk_2.magnitude=5.039e-4"]


def test_a_bistable_speed_says_so_and_lets_choose():
    """At 4100 rpm the heavy rotor is low or high, by a run-up or after a coast-down."""
    printed = json.loads(run("solve", PAPER, "--rpm", "4100", *HEAVY, "--json").stdout)
    stable = [one for one in printed["others"] if one["stable"]]
    assert printed["stable"]
    [upper] = stable
    near = ["--near", f"{upper['eccentricity_max']:.3f}"]
    chosen = json.loads(run("solve", PAPER, "--rpm", "4100", *HEAVY, *near, "--json").stdout)
    damper = chosen["dampers"]["damper_1"]
    assert damper["eccentricity_max"] == pytest.approx(upper["eccentricity_max"], abs=1e-7)
    lower = printed["dampers"]["damper_1"]["eccentricity_max"]
    assert lower in [pytest.approx(one["eccentricity_max"], abs=1e-7) for one in chosen["others"]]
    assert chosen["greatest_vibration"]["of"] == "disk_2"
    assert chosen["greatest_vibration"]["vibration"] > 1e-3
    text = run("solve", PAPER, "--rpm", "4100", *HEAVY).stdout
    assert "bistable: " in text
    assert f"another response, stable, has eccentricity {upper['eccentricity_max']:.4f}" in text
    assert "greatest vibration of any disk 263.1 um zero to peak: disk_2" in text


def test_where_there_is_one_response_nothing_is_said_of_others():
    done = run("solve", PAPER, "--rpm", "3000", *HEAVY)
    assert "bistable" not in done.stdout
    assert "another response" not in done.stdout


def test_sag_beyond_the_clearance_is_told_with_its_number():
    """As the uncondensed rotor has it on its springs alone."""
    soft = ["--set", "gravity=true", "--set", "dampers.damper_1.centering_stiffness=2e4"]
    machine = override_all(
        read_machine(PAPER), {"gravity": True, "dampers.damper_1.centering_stiffness": 2e4}
    )
    model = assemble(machine)
    at_rest = np.linalg.solve(model.K, model.static_force)[model.journals[0]]
    sag = np.linalg.norm(at_rest) / 2.54e-4
    assert sag > 1.0
    words = f"at rest damper_1 sags by {sag:.2f} of its clearance ("
    assert words in run("solve", PAPER, "--rpm", "3800", "--harmonics", "3", *soft).stdout
    still = ["--set", "unbalance.disk_2.magnitude=0"]
    assert words in run("solve", PAPER, "--rpm", "3000", *soft, *still).stderr
    printed = json.loads(run("solve", PAPER, "--rpm", "3800", *soft, "--json").stdout)
    assert printed["sag"]["damper_1"] == pytest.approx(sag, rel=1e-6)
    assert " of its clearance (" not in run("solve", PAPER, "--rpm", "3800").stdout


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((), "sfd_hbm: the following arguments are required: VERB"),
        (("turn", PAPER), "sfd_hbm: argument VERB: invalid choice: 'turn'"),
        (("solve", PAPER), "sfd_hbm solve: the following arguments are required: --rpm"),
        (("solve", PAPER, "--rpm", "-3"), "sfd_hbm: --rpm -3: must be a finite speed above 0 rpm"),
        (("solve", PAPER, "--rpm", "nan"), "sfd_hbm: --rpm nan: must be a finite speed above 0"),
        (
            ("solve", PAPER, "--rpm", "9", "--near", "1.5"),
            "sfd_hbm: --near 1.5: must be an eccentricity of at least 0, below 1",
        ),
        (("solve", PAPER, "--rpm", "fast"), "sfd_hbm solve: argument --rpm: invalid float value"),
        (("modes", PAPER, "--rpm", "-1"), "sfd_hbm: --rpm -1: must be a finite speed of at least"),
        (("solve", "none.yaml", "--rpm", "9"), "sfd_hbm: none.yaml: cannot be read: No such file"),
        (("modes", PAPER, "--set", "gravity"), "sfd_hbm: --set gravity: must have the form PATH="),
        (("modes", PAPER, "--set", "gravity=[1"), "sfd_hbm: --set gravity: line 1"),
        (
            ("modes", PAPER, "--set", "dampers.damper_1.clearance=-1"),
            "sfd_hbm: dampers.damper_1.clearance must be a finite number [m] above 0, not -1",
        ),
        (
            ("solve", PAPER, "--rpm", "9", "--harmonics", "0"),
            "sfd_hbm: harmonics: 0 is not allowed, it must be at least 1",
        ),
    ],
)
def test_bad_input_is_status_2_and_one_sentence(arguments, sentence):
    done = run(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(sentence)
    assert done.stderr.count("\n") == 1


def test_modes_of_the_paper_rotor():
    """Below the pinned-pinned critical speed near 4 160 rpm, since the spring gives way."""
    criticals = json.loads(run("modes", PAPER, "--json").stdout)["critical_speeds"]
    first = next(c["speed_rpm"] for c in criticals if c["direction"] == "forward")
    assert 3600.0 < first < 4160.0
    speeds = [c["speed_rpm"] for c in criticals]
    assert speeds == sorted(speeds)
    assert speeds[-1] <= 10.0 * speeds[0]
    # at its critical speed a mode whirls as fast as the rotor turns
    at_first = json.loads(run("modes", PAPER, "--rpm", repr(first), "--json").stdout)
    forward = [m["frequency_rad_s"] for m in at_first["modes"] if m["direction"] == "forward"]
    assert forward[0] == pytest.approx(first * np.pi / 30.0, rel=1e-9)


def test_modes_for_people_are_a_table():
    lines = run("modes", PAPER).stdout.splitlines()
    assert lines[0].split() == ["speed_rpm", "direction"]
    assert lines[1].split()[1] == "backward"
