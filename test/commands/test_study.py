"""The verb `study`: its rows against curves one by one, its statistics, what it refuses."""

import json
import sys

import numpy as np
import pytest

from sfd_hbm_ros.cli import main
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, override_all, read_machine
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.curves.summary import Summary

from .studies import CURVE, GRID, PAPER, SPRING, UNBALANCE, VARIANTS, rows, timeless

RPM = np.pi / 30.0
MACHINE = read_machine(PAPER)


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    """A finished study of the grid."""
    path = tmp_path_factory.mktemp("study") / "grid.csv"
    assert main(["study", PAPER, *CURVE, *GRID, "--output", str(path)]) == 0
    return path


def number(text):
    return float(text) if text else None


def test_rows_of_a_grid_are_what_single_curves_give(output):
    table = rows(output)
    assert [int(row["variant"]) for row in table] == list(range(VARIANTS))
    assert {bool(row["run_up_rpm"]) for row in table} == {True, False}  # some jump, some do not
    for row in table[::3] + table[-1:]:
        changes = {path: float(row[path]) for path in (UNBALANCE, SPRING)}
        balance = HarmonicBalance(override_all(MACHINE, changes), Harmonics(1))
        summary = Summary(response_curve(balance, 3900.0 * RPM, 4020.0 * RPM))
        jumps = {jump.direction: jump.value / RPM for jump in reversed(summary.jumps)}
        assert number(row["run_up_rpm"]) == pytest.approx(jumps.get(Direction.RUN_UP))
        assert number(row["coast_down_rpm"]) == pytest.approx(jumps.get(Direction.COAST_DOWN))
        width = summary.hysteresis
        assert number(row["width_rpm"]) == pytest.approx(width and width / RPM)
        assert float(row["peak_rpm"]) == pytest.approx(summary.peak.value / RPM)
        assert float(row["peak_eccentricity"]) == pytest.approx(summary.peak.eccentricity)
        assert 0.0 < float(row["seconds"]) < 60.0
        assert row["reason"] == ""


def test_finished_study_is_written_again_from_its_journal(output, tmp_path, capsys):
    written, picture = output.read_bytes(), tmp_path / "jumps.png"
    again = ["study", PAPER, *CURVE, *GRID, "--output", str(output), "--picture", str(picture)]
    assert main([*again, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["variants"] == printed["from_journal"] == VARIANTS
    assert printed["without_solution"] == printed["incomplete"] == 0
    assert output.read_bytes() == written
    assert picture.read_bytes().startswith(b"\x89PNG")
    up, down = printed["jumps"]
    assert (up["direction"], down["direction"]) == ("run_up", "coast_down")
    speeds = [float(row["run_up_rpm"]) for row in rows(output) if row["run_up_rpm"]]
    assert up["probability"] == len(speeds) / VARIANTS
    assert up["speed_rpm"]["50%"] == pytest.approx(np.median(speeds))
    assert main(again) == 0
    assert f"{VARIANTS} of them from the journal" in capsys.readouterr().out


def test_samples_of_a_linear_response(tmp_path, capsys):
    """Far below the clearance the film is linear: eccentricity is as unbalance.

    Its mean and standard deviation are then those of the unbalance, times the eccentricity that
    a single solution has per kg m, to the accuracy of 40 samples.
    """
    output, mean, deviation, samples = tmp_path / "linear.csv", 4e-7, 5e-8, 40
    sample = ["--sample", f"{UNBALANCE}=normal({mean},{deviation})", "--samples", str(samples)]
    speeds = ["--rpm", "3000:3005", "--harmonics", "1"]
    assert main(["study", PAPER, *speeds, *sample, "--output", str(output)]) == 0
    assert "run-up     0 % of the variants jump" in capsys.readouterr().out
    table = rows(output)
    assert [row["peak_rpm"] for row in table] == [table[0]["peak_rpm"]] * samples
    balance = HarmonicBalance(override(MACHINE, UNBALANCE, mean), Harmonics(1))
    direct = solve(balance, 3005.0 * RPM).eccentricity_max / mean
    unbalance = np.array([float(row[UNBALANCE]) for row in table])
    eccentricity = np.array([float(row["peak_eccentricity"]) for row in table])
    assert eccentricity == pytest.approx(direct * unbalance, rel=1e-4)
    error = deviation / np.sqrt(samples)
    assert eccentricity.mean() == pytest.approx(direct * mean, abs=3.0 * direct * error)
    assert eccentricity.std() == pytest.approx(direct * deviation, abs=3.0 * direct * error)


def test_parquet_holds_what_csv_holds(output, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    copy = tmp_path / "grid.parquet"
    journal = output.with_name("grid.csv.journal").read_bytes()
    (tmp_path / "grid.parquet.journal").write_bytes(journal)
    assert main(["study", PAPER, *CURVE, *GRID, "--output", str(copy)]) == 0
    table = parquet.read_table(copy).to_pylist()
    text = [{key: "" if one is None else str(one) for key, one in row.items()} for row in table]
    assert timeless(text) == timeless(rows(output))
    assert isinstance(table[0]["peak_rpm"], float)


def test_no_solution_is_a_row_with_its_reason(tmp_path, capsys):
    """Without unbalance nothing lifts the journal, and the soft spring cannot."""
    output = tmp_path / "some.csv"
    changes = ["--set", "gravity=true", "--set", f"{UNBALANCE}=0"]
    soft = ["--vary", f"{SPRING}=2e4:2e7:2", "--rpm", "3900:3905", "--harmonics", "2"]
    assert main(["study", PAPER, *changes, *soft, "--output", str(output)]) == 0
    assert "1 without a solution: column reason says why" in capsys.readouterr().out
    failed, solved = rows(output)
    assert failed["reason"].startswith("no solution at 3900 rpm: ")
    assert failed["peak_rpm"] == failed["run_up_rpm"] == ""
    assert solved["reason"] == ""
    assert float(solved["peak_eccentricity"]) > 0.0


def test_no_solution_at_all_is_status_1(tmp_path, capsys):
    output = tmp_path / "none.csv"
    changes = ["--set", "gravity=true", "--set", f"{UNBALANCE}=0"]
    soft = ["--vary", f"{SPRING}=2e4:3e4:2", "--rpm", "3900:3905", "--harmonics", "2"]
    assert main(["study", PAPER, *changes, *soft, "--output", str(output)]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("sfd_hbm: none of the 2 variants has a solution; variant 0: no solution")
    assert err.count("\n") == 1
    assert len(rows(output)) == 2


def test_another_study_does_not_mix_with_the_first(output, capsys):
    other = ["--rpm", "3900:4021", "--harmonics", "1", "--no-detached"]
    assert main(["study", PAPER, *other, *GRID, "--output", str(output)]) == 2
    _, err = capsys.readouterr()
    assert err == (
        f"sfd_hbm: {output}.journal: holds a study with another rpm; delete it, or give another "
        "--output\n"
    )


SAMPLE = f"{UNBALANCE}=normal(4.3e-4,1e-5)"


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ((), "nothing varies: a study needs --vary or --sample"),
        (("--vary", "x=1:2:3"), "x is unknown"),
        (("--vary", "gravity=0:1:2"), "gravity must be a number to vary"),
        (("--vary", f"{SPRING}=1:2"), f"--vary {SPRING}=1:2: must be PATH=A:B:N with N values"),
        (("--vary", f"{SPRING}=1:2:1"), f"--vary {SPRING}=1:2:1: must be PATH=A:B:N with N"),
        (("--vary", f"{SPRING}=1:x:3"), f"--vary {SPRING} 1:x: must be A:B with two"),
        (("--vary", f"{SPRING}=1:2:2") * 2, f"--vary {SPRING}: must be given once"),
        (
            ("--vary", f"{SPRING}=2e6:-1e6:4"),
            f"variant 3: {SPRING} must be a finite number [N/m] of at least 0, not -1000000.0",
        ),
        (("--sample", SAMPLE), "--sample and --samples: must be given together"),
        (("--samples", "3"), "--sample and --samples: must be given together"),
        (("--sample", SAMPLE, "--samples", "0"), "--samples 0: must be at least 1"),
        (("--sample", SAMPLE, "--samples", "9", "--seed", "-1"), "--seed -1: must be at least 0"),
        (("--vary", f"{SPRING}=1:2:2", "--seed", "1"), "--seed 1: is for --sample"),
        (
            ("--sample", f"{SPRING}=cauchy(0,1)", "--samples", "3"),
            f"--sample {SPRING}=cauchy(0,1): must be PATH=normal(MEAN,SD), PATH=uniform(A,B) or",
        ),
        (
            ("--sample", f"{SPRING}=normal(a,1)", "--samples", "3"),
            f"--sample {SPRING}=normal(a,1): a is not a number",
        ),
        (
            ("--sample", f"{SPRING}=uniform(2,1)", "--samples", "3"),
            f"--sample {SPRING}=uniform(2,1): must be uniform(A,B) of finite numbers with A below",
        ),
        (("--vary", f"{SPRING}=1:2:2", "--harmonics", "0"), "harmonics: 0 is not allowed"),
        (("--vary", f"{SPRING}=1:2:2", "--rpm", "0:9"), "--rpm 0: must be a finite speed above"),
        (
            ("--vary", f"{SPRING}=1:2:2", "--at", "5000"),
            "--at 5000: must lie in the range of ",
        ),
        (
            ("--vary", f"{SPRING}=1:2:2", "--at", "nan"),
            "--at nan: must be a finite speed above",
        ),
    ],
)
def test_bad_input_is_refused_before_anything_runs(options, sentence, tmp_path, capsys):
    output = tmp_path / "refused.csv"
    assert main(["study", PAPER, *CURVE, *options, "--output", str(output)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"sfd_hbm: {sentence}")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "module", "sentence"),
    [
        ((), "pyarrow", "Parquet needs pyarrow, which is not installed"),
        (("--scheduler", "tcp://127.0.0.1:9"), "distributed", "needs the Python package distribu"),
    ],
)
def test_optional_packages_that_are_missing(
    options, module, sentence, tmp_path, monkeypatch, capsys
):
    """None in sys.modules is how Python is told that a module cannot be imported."""
    monkeypatch.setitem(sys.modules, module, None)
    output = tmp_path / ("study.csv" if options else "study.parquet")
    assert main(["study", PAPER, *CURVE, *GRID, "--output", str(output), *options]) == 2
    _, err = capsys.readouterr()
    assert sentence in err
    assert err.count("\n") == 1
