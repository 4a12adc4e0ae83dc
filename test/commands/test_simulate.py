"""The verb `simulate`: results, files, progress and refusals."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.cli import main
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.response.integration.transient import simulate

ROOT = Path(__file__).parents[2]
PAPER = str(ROOT / "config" / "paper_rotor.yaml")
RPM = np.pi / 30.0
COAST_DOWN = ("--from", "3910", "--to", "3900", "--rate", "30")


@pytest.fixture(scope="module")
def coast_down():
    """What the library computes for the same run."""
    balance = HarmonicBalance(read_machine(PAPER), Harmonics(3))
    return simulate(balance, 3910.0 * RPM, 3900.0 * RPM, 30.0 * RPM)


def test_json_and_files_hold_what_the_library_computes(coast_down, tmp_path, capsys):
    table, picture = tmp_path / "run.csv", tmp_path / "run.png"
    options = [*COAST_DOWN, "--harmonics", "3", "--json"]
    files = ["--output", str(table), "--picture", str(picture)]
    assert main(["simulate", PAPER, *options, *files]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    printed = json.loads(out)
    assert list(printed) == ["revolutions", "duration", "peak", "jumps", "seconds"]
    assert printed["revolutions"] == coast_down.ramp.revolutions == 21
    assert printed["duration"] == pytest.approx(10.0 / 30.0, abs=60.0 / 3900.0)
    eccentricity = coast_down.eccentricity_max["damper_1"]
    assert printed["peak"]["eccentricity"] == pytest.approx(eccentricity.max(), rel=1e-9)
    assert printed["jumps"] == []
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert list(rows[0]) == [
        "time_s",
        "speed_rpm",
        "damper_1.eccentricity_max",
        "damper_1.eccentricity_mean",
    ]
    columns = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    assert columns["time_s"] == pytest.approx(coast_down.time, rel=1e-9)
    assert columns["speed_rpm"] == pytest.approx(coast_down.speed / RPM, rel=1e-9)
    assert columns["damper_1.eccentricity_max"] == pytest.approx(eccentricity, rel=1e-9)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_jumps_are_listed_for_people(capsys):
    """At this rate the paper's rotor falls some 35 rpm above its fold near 3957 rpm."""
    options = ["--from", "3950", "--to", "4020", "--rate", "30", "--harmonics", "3"]
    assert main(["simulate", PAPER, *options]) == 0
    run, peak, jump = capsys.readouterr().out.splitlines()
    assert run.startswith("154 revolutions, 2.32 s of the machine's time, in ")
    assert peak.split()[0] == "peak"
    word, speed, _, _, before, _, after = jump.split()
    assert word == "jump"
    assert 3957.0 < float(speed) < 4010.0
    assert float(before) > 0.6
    assert float(after) < 0.5


def test_progress_is_for_a_terminal():
    screen, terminal = os.openpty()
    command = [sys.executable, "-m", "sfd_hbm_ros", "simulate", PAPER, *COAST_DOWN]
    done = subprocess.run(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=terminal, timeout=60
    )
    os.close(terminal)
    shown = os.read(screen, 65536).decode()
    os.close(screen)
    assert done.returncode == 0
    assert "%  39" in shown
    assert shown.endswith("\r\x1b[K")  # wiped at the end


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--from", "0"), "sfd_hbm: --from 0: must be a finite speed above 0 rpm"),
        (("--to", "nan"), "sfd_hbm: --to nan: must be a finite speed above 0 rpm"),
        (("--to", "3910"), "sfd_hbm: --to 3910: must differ from --from 3910 rpm"),
        (("--rate", "-30"), "sfd_hbm: --rate -30: must be a finite rate above 0 rpm/s"),
        (("--rate", "1e6"), "sfd_hbm: rate: 104720 rad/s2 leads from 409.454 to 408.407 rad/s in"),
        (("--harmonics", "0"), "sfd_hbm: harmonics: 0 is not allowed"),
        (("--output", "no/such/folder.csv"), "sfd_hbm: --output no/such/folder.csv: no file can "),
    ],
)
def test_bad_input_is_status_2_and_one_sentence(arguments, sentence, capsys):
    assert main(["simulate", PAPER, *COAST_DOWN, *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(sentence)
    assert err.count("\n") == 1


def test_no_start_is_status_1_and_one_sentence(capsys):
    """Without unbalance nothing lifts the journal, and the soft spring cannot."""
    changes = {
        "unbalance.disk_2.magnitude": "0",
        "gravity": "true",
        "dampers.damper_1.centering_stiffness": "2e4",
    }
    options = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
    assert main(["simulate", PAPER, *COAST_DOWN, *options]) == 1
    _, err = capsys.readouterr()
    assert err.startswith("sfd_hbm: no solution to start from at 3910 rpm: the load")
    assert err.count("\n") == 1
