"""The verb `study` where there are several responses: a rigid rotor's are in closed form.

The speeds of folds are those of Taylor and Kumar 1980 and Cookson and Kossa 1979, as multiples of
the natural frequency on the springs, which is 100 rad/s here.
"""

import json

import numpy as np
import pytest

from sfd_hbm_ros.cli import main
from sfd_hbm_ros.machine import write_machine

from ..hbm.machines import rigid_balance, rigid_rotor
from .studies import rows

NATURAL = 100.0 * 30.0 / np.pi  # [rpm]
UNBALANCE = "unbalance.disk.magnitude"  # 1e-3 times that of the closed form


def studied(tmp_path, film, range_, *options, unbalances="2e-4:4e-4:2"):
    """What a study of two unbalances prints, and its rows."""
    machine, output = tmp_path / "rigid.yaml", tmp_path / "study.csv"
    write_machine(rigid_rotor(0.2, film), machine)
    low, high = (end * NATURAL for end in range_)
    vary = ["--vary", f"{UNBALANCE}={unbalances}", "--rpm", f"{low}:{high}", "--harmonics", "1"]
    assert main(["study", str(machine), *vary, *options, "--output", str(output)]) == 0
    return rows(output)


def speed(row, column):
    """A speed over the natural frequency."""
    return float(row[column]) / NATURAL if row[column] else None


def test_a_rotor_that_locks_up_is_told_so(tmp_path, capsys):
    """Lock-up for ever from an unbalance of 0.331 on, and a lower response from 2.113 on."""
    free, locked = studied(tmp_path, 0.1, (0.5, 4.0), "--at", f"{3.0 * NATURAL}")
    printed = capsys.readouterr().out
    assert (free["locked_up"], free["detached"], free["responses"]) == ("0", "0", "1")
    assert (locked["locked_up"], locked["detached"], locked["responses"]) == ("1", "1", "2")
    assert locked["run_up_rpm"] == ""
    assert speed(locked, "several_from_rpm") == pytest.approx(2.113021, rel=1e-3)
    assert speed(locked, "several_to_rpm") == pytest.approx(4.0)
    worst, best = (float(locked[f"{which}_eccentricity"]) for which in ("worst", "best"))
    assert worst > 0.8 > 0.5 > best
    for row, unbalance in ((free, 0.2), (locked, 0.4)):
        for which in ("worst", "best"):
            eccentricity = float(row[f"{which}_eccentricity"])
            assert rigid_balance(unbalance, 0.1, 3.0, eccentricity) == pytest.approx(0.0, abs=2e-3)
            assert float(row[f"{which}_vibration"]) == pytest.approx(eccentricity)  # of a circle
    assert float(locked["peak_vibration"]) == pytest.approx(float(locked["peak_eccentricity"]))
    assert "run-up     0 % of the variants jump" in printed
    assert "50 % of the variants have a second stable response somewhere from 2017" in printed
    assert "50 % of the variants stay locked up on the upper response to the end of t" in printed
    assert "50 % of the variants have a stable response that neither run-up nor coast" in printed
    assert "rpm 1 of 2 variants have more than one stable response" in printed


def test_a_detached_branch_far_above_the_hysteresis(tmp_path, capsys):
    smaller, larger = studied(tmp_path, 0.02, (0.5, 12.0), "--json", unbalances="1e-4:2e-4:2")
    printed = json.loads(capsys.readouterr().out)
    assert speed(smaller, "coast_down_rpm") == pytest.approx(1.124168, rel=1e-3)
    assert speed(smaller, "run_up_rpm") == pytest.approx(1.147360, rel=1e-3)
    assert speed(smaller, "several_from_rpm") == speed(smaller, "coast_down_rpm")
    assert speed(smaller, "several_to_rpm") == speed(smaller, "run_up_rpm")
    assert speed(larger, "coast_down_rpm") == pytest.approx(1.252253, rel=1e-3)
    assert speed(larger, "run_up_rpm") == pytest.approx(1.590524, rel=1e-3)
    assert (smaller["detached"], larger["detached"]) == ("0", "1")
    assert speed(larger, "several_to_rpm") == pytest.approx(12.0)
    assert (smaller["locked_up"], larger["locked_up"]) == ("0", "0")
    assert smaller["responses"] == larger["worst_vibration"] == ""
    assert printed["several_responses"]["probability"] == 1.0
    assert printed["detached"] == {"probability": 0.5}
    assert printed["locked_up"] == {"probability": 0.0}
    assert printed["at"] is None


def test_without_the_search_for_detached_branches_nothing_is_said_of_them(tmp_path, capsys):
    _, locked = studied(tmp_path, 0.1, (0.5, 4.0), "--no-detached")
    assert locked["detached"] == ""
    assert "neither run-up nor coast-down" not in capsys.readouterr().out
