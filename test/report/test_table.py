"""Tables of curves, read back from their files."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.report.table import write_table

from .curves import DAMPER, RPM, UNBALANCE, jumping, made, motion, sagging, unbalanced


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("curve", [jumping, sagging])
def test_round_trip(curve, tmp_path):
    """Every number comes back as it was, point by point in the order of the arc."""
    write_table(curve(), tmp_path / "curve.csv")
    rows = [row for row in read(tmp_path / "curve.csv") if not row["frequency_ratio"]]
    points = [
        (solution, stable)
        for branch in curve().branches
        if branch.periodic
        for solution, stable in zip(branch.solutions, branch.stable, strict=True)
    ]
    harmonics = curve().balance.harmonics
    waves = [f"{n}_{wave}" for n in range(1, harmonics.highest + 1) for wave in ("cos", "sin")]
    for row, (solution, stable) in zip(rows, points, strict=True):
        journal = solution.journals[DAMPER]
        assert float(row["speed_rpm"]) == solution.speed / RPM
        assert row["stable"] == ("1" if stable else "0")
        assert float(row[f"{DAMPER}.eccentricity_max"]) == journal.eccentricity_max
        for column, axis in enumerate("xy"):
            written = [float(row[f"{DAMPER}.{axis}_{wave}"]) for wave in ("0", *waves)]
            assert written == journal.coefficients[:, column].tolist()


def test_columns(tmp_path):
    write_table(jumping(), tmp_path / "curve.csv")
    header = (tmp_path / "curve.csv").read_text().splitlines()[0]
    assert header == (
        "speed_rpm,stable,damper_1.eccentricity_max,damper_1.x_0,damper_1.x_1_cos,"
        "damper_1.x_1_sin,damper_1.y_0,damper_1.y_1_cos,damper_1.y_1_sin,"
        "orders,branch,frequency_ratio"
    )


def test_quasi_periodic_response_has_a_second_frequency_and_no_orders(tmp_path):
    write_table(jumping(), tmp_path / "curve.csv")
    rows = [row for row in read(tmp_path / "curve.csv") if row["branch"] == "2"]
    leaving = jumping().branches[2]
    for row, response, stable in zip(rows, leaving.solutions, leaving.stable, strict=True):
        filled = {column for column, cell in row.items() if cell}
        assert filled == {
            "speed_rpm",
            "stable",
            f"{DAMPER}.eccentricity_max",
            "branch",
            "frequency_ratio",
        }
        assert float(row["frequency_ratio"]) == response.frequency / response.speed
        assert float(row[f"{DAMPER}.eccentricity_max"]) == response.eccentricity_max
        assert row["stable"] == ("1" if stable else "0")


def test_orders_in_use_and_branches(tmp_path):
    """Orders whose coefficients are zero are not in use; detached branches come last."""
    still = motion(np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 2.0], [0.0, 0.0]]))
    half = motion(np.arange(10.0).reshape(5, 2), highest=1, revolutions=2)
    main, other = made([100.0, 200.0], [still, still]), made([300.0], [half])
    curve = replace(main, branches=(*main.branches, *other.branches), detached=main.branches)
    write_table(curve, tmp_path / "curve.csv")
    rows = read(tmp_path / "curve.csv")
    assert [row["branch"] for row in rows] == ["0", "0", "1", "2", "2"]
    assert [row["orders"] for row in rows] == ["0 2", "0 2", "0 1/2 1", "0 2", "0 2"]


def test_an_entry_that_varies_has_a_column(tmp_path):
    write_table(unbalanced(), tmp_path / "curve.csv")
    rows = read(tmp_path / "curve.csv")
    assert list(rows[0])[:3] == ["speed_rpm", UNBALANCE, "stable"]
    assert [float(row[UNBALANCE]) for row in rows] == unbalanced().branches[0].values.tolist()
    assert {float(row["speed_rpm"]) for row in rows} == {4050.0 * RPM / RPM}


def test_harmonics_left_out_at_a_point_are_zero(tmp_path):
    full = motion(np.arange(10.0).reshape(5, 2))
    selected = motion(np.arange(6.0).reshape(3, 2), highest=2, multiples=(0, 2))
    write_table(made([100.0, 200.0], [full, selected]), tmp_path / "curve.csv")
    row = read(tmp_path / "curve.csv")[1]
    x = [float(row[f"{DAMPER}.x_{wave}"]) for wave in ("0", "1_cos", "1_sin", "2_cos", "2_sin")]
    assert x == [0.0, 0.0, 0.0, 2.0, 4.0]


def test_sub_harmonics_are_named_by_their_order(tmp_path):
    half = motion(np.arange(10.0).reshape(5, 2), highest=1, revolutions=2)
    assert half.harmonics == Harmonics(1, revolutions=2)
    write_table(made([100.0], [half]), tmp_path / "curve.csv")
    [row] = read(tmp_path / "curve.csv")
    assert float(row[f"{DAMPER}.y_1/2_sin"]) == 5.0
    assert float(row[f"{DAMPER}.y_1_sin"]) == 9.0


def test_columns_hold_the_orders_of_every_branch(tmp_path):
    whole = made([100.0], [motion(np.arange(6.0).reshape(3, 2))])
    half = made([200.0], [motion(np.arange(10.0).reshape(5, 2), highest=1, revolutions=2)])
    write_table(replace(whole, branches=(*whole.branches, *half.branches)), tmp_path / "curve.csv")
    first, second = read(tmp_path / "curve.csv")
    waves = ("0", "1/2_cos", "1/2_sin", "1_cos", "1_sin")
    x = [[float(row[f"{DAMPER}.x_{wave}"]) for wave in waves] for row in (first, second)]
    assert x == [[0.0, 0.0, 0.0, 2.0, 4.0], [0.0, 2.0, 4.0, 6.0, 8.0]]
