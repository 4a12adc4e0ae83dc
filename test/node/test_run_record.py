import math

import numpy as np
import pytest

from sfd_hbm_ros.node.run_record import DamperPoint, RunPoint, RunRecord
from sfd_hbm_ros.node.run_text import HEADER, diagnosis, rows, summary

RPM = math.pi / 30.0  # rad/s


def at(rpm: float, eccentricity: float, time: float = 0.0) -> RunPoint:
    damper = DamperPoint(eccentricity, 0.9 * eccentricity, (5.0e-5, 2.5e-7))
    return RunPoint(time, rpm, {"damper_1": damper})


def recorded(*points: tuple[float, float]) -> RunRecord:
    record = RunRecord()
    for rpm, eccentricity in points:
        record.points.append(at(rpm, eccentricity))
    return record


def test_ways_are_told_apart_by_the_change_of_the_speed() -> None:
    record = recorded((1, 0.1), (2, 0.2), (3, 0.3), (3, 0.35), (2, 0.25), (1, 0.15))
    assert record.way("damper_1", 1).tolist() == [[2, 0.2], [3, 0.3]]
    assert record.way("damper_1", -1).tolist() == [[1, 0.15], [2, 0.25]]


def test_difference_between_up_and_down_where_the_samples_interleave() -> None:
    """Up on e = n/10 000, down by 0.03 more between 2 000 and 3 000 rpm, at other speeds."""
    up = [(n, n * 1e-4) for n in np.arange(1000.0, 5000.0, 10.0)]
    down = [
        (n, n * 1e-4 + (0.03 if 2000.0 < n < 3000.0 else 0.0))
        for n in np.arange(4995.0, 999.0, -10.0)
    ]
    difference, rpm = recorded(*up, *down).largest_difference("damper_1") or (0.0, 0.0)
    assert difference == pytest.approx(0.03, rel=1e-9)
    assert 2000.0 < rpm < 3000.0


def test_no_difference_is_made_up_where_predictions_are_missing() -> None:
    """Up and down on the same curve, of which the way down misses the peak."""
    curve = [(n, 1.0 / (1.0 + (n - 50.0) ** 2)) for n in np.arange(0.0, 100.0, 0.25)]
    sides = [(n, e) for n, e in curve if abs(n - 50.0) > 5.0]
    difference, _ = recorded(*curve, *reversed(sides)).largest_difference("damper_1") or (9.0, 0.0)
    assert difference < 1e-12


def test_no_difference_without_a_way_down() -> None:
    assert recorded((1, 0.1), (2, 0.2)).largest_difference("damper_1") is None
    assert RunRecord().largest_difference("damper_1") is None


def test_speeds_without_a_solution_are_counted_and_left_out() -> None:
    record = recorded((1, 0.1), (2, math.nan), (3, 0.3))
    assert record.way("damper_1", 1).tolist() == [[3, 0.3]]
    assert "3 predictions, 1 of them without a solution" in summary(record)


def test_record_joins_what_comes_under_one_stamp_in_any_order() -> None:
    record = RunRecord()
    second = 1_000_000_000
    record.take(5 * second, "speed", 1000.0 * RPM)
    assert record.news == RunPoint(0.0, pytest.approx(1000.0))
    record.take(7 * second, "harmonics", {"a": [1e-6, 2e-6]})
    record.take(5 * second, "eccentricity", {"a": (0.9, 0.8)})
    record.take(7 * second, "eccentricity", {"a": (0.5, 0.4)})
    assert not record.points
    record.take(7 * second, "speed", 1100.0 * RPM)
    expected = RunPoint(2.0, pytest.approx(1100.0), {"a": DamperPoint(0.5, 0.4, (1e-6, 2e-6))})
    assert list(record.points) == [expected]
    record.take(8 * second, "speed", 1200.0 * RPM)
    assert record.news == expected
    assert record.speeds == 3


def test_record_forgets_the_oldest_stamps_that_stay_incomplete() -> None:
    record = RunRecord()
    for stamp in range(1, 1003):
        record.take(stamp, "speed", 100.0)
    for part in ("eccentricity", "harmonics"):
        for stamp in (1, 1002):
            record.take(stamp, part, {})
    assert len(record.points) == 1


def test_summary_names_peaks_and_difference() -> None:
    record = recorded((1000, 0.1), (2000, 0.5), (3000, 0.2), (2000, 0.6), (1000, 0.1))
    record.speeds = 7
    assert summary(record).splitlines() == [
        "7 speeds, 5 predictions, 0 of them without a solution",
        "damper_1, on the way up: peak eccentricity 0.5000 at 2000 rpm",
        "damper_1, on the way down: peak eccentricity 0.6000 at 2000 rpm",
        "damper_1, up and down differ by at most 0.1000, at 2000 rpm",
    ]


def test_row_stands_under_the_header_with_a_dash_for_what_is_missing() -> None:
    row = rows(at(3000.0, 0.5, time=2.0))
    assert row.split() == ["2.0", "3000", "damper_1", "0.5000", "0.4500", "50.000", "0.250", "-"]
    titles = HEADER.splitlines()[1]
    values = {"[s]": "2.0", "[rpm]": "3000", "max": "0.5000", "1x": "50.000", "2x": "0.250"}
    for title, value in values.items():
        assert titles.index(title) + len(title) == row.index(value) + len(value)


def test_every_damper_has_a_row_and_a_speed_alone_too() -> None:
    point = DamperPoint(math.nan, math.nan, ())
    lines = rows(RunPoint(2.0, 3000.0, {"a": point, "b": point})).splitlines()
    assert [line.split()[:4] for line in lines] == [["2.0", "3000", name, "nan"] for name in "ab"]
    assert rows(RunPoint(2.0, 3000.0)).split() == ["2.0", "3000", "no", "prediction"]


@pytest.mark.parametrize(("level", "word"), [(1, "WARN"), (2, "ERROR"), (9, "unknown")])
def test_diagnosis_names_the_level(level: int, word: str) -> None:
    assert diagnosis("predictor: Solver", level, "so").strip() == f"predictor: Solver {word}: so"
