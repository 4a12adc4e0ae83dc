import math

import numpy as np
import pytest

from sfd_hbm_ros.node.monitor.run_point import DamperPoint, RunPoint
from sfd_hbm_ros.node.monitor.run_record import RunRecord
from sfd_hbm_ros.node.monitor.run_text import HEADER, alarm, diagnosis, rows, summary
from sfd_hbm_ros.node.monitor.run_warnings import JumpWarning, WarningRecord

RPM = math.pi / 30.0  # rad/s
SECOND = 1_000_000_000  # ns


def at(rpm: float, eccentricity: float, time: float = 0.0) -> RunPoint:
    damper = DamperPoint(eccentricity, 0.9 * eccentricity, (5.0e-5, 2.5e-7), (5.1e-5, 2.5e-7))
    return RunPoint(round(time * SECOND), time, rpm, {"damper_1": damper})


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
    assert "3 predictions, 1 of them without a solution" in summary(record, WarningRecord())


def test_record_joins_what_comes_under_one_stamp_in_any_order() -> None:
    record = RunRecord()
    second = SECOND
    record.take(5 * second, "speed", 1000.0 * RPM)
    assert record.news == RunPoint(5 * second, 0.0, pytest.approx(1000.0))
    record.take(7 * second, "harmonics", {"a": [1e-6, 2e-6]})
    record.take(5 * second, "eccentricity", {"a": (0.9, 0.8)})
    record.take(7 * second, "eccentricity", {"a": (0.5, 0.4)})
    assert not record.points
    record.take(7 * second, "speed", 1100.0 * RPM)
    damper = DamperPoint(0.5, 0.4, (1e-6, 2e-6))
    expected = RunPoint(7 * second, 2.0, pytest.approx(1100.0), {"a": damper})
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


def complete(record: RunRecord, stamp: int) -> RunPoint | None:
    """Let a prediction of 10 um come with a stamp [ns]."""
    record.take(stamp, "speed", 100.0)
    record.take(stamp, "eccentricity", {"a": (0.5, math.nan)})
    return record.take(stamp, "harmonics", {"a": [10e-6]})


def test_a_measured_orbit_belongs_to_the_prediction_with_its_stamp() -> None:
    record = RunRecord()
    record.measure(2, {"a": [9e-6, 1e-6]})
    first, second = complete(record, 1), complete(record, 2)
    assert first is not None
    assert second is not None
    assert math.isnan(first.dampers["a"].disagreement)
    assert second.dampers["a"].measured == (9e-6, 1e-6)
    assert record.news is second
    assert complete(record, 3) is not None
    assert record.news is second, "a point with a measured orbit is the better news"
    assert record.disagreements("a") == pytest.approx([0.1])


def test_measured_orbits_without_a_prediction_are_forgotten() -> None:
    record = RunRecord()
    for stamp in range(1, 102):
        record.measure(stamp, {"a": [9e-6]})
    points = [complete(record, stamp) for stamp in (1, 101)]
    assert [point.measured for point in points if point] == [False, True]


def warning(time: float, level: int, rpm: float, direction: str = "run_up") -> JumpWarning:
    return JumpWarning(round(time * SECOND), level, f"expected at {rpm}", direction, rpm, 3.0)


def test_a_warning_is_new_if_more_than_its_numbers_has_changed() -> None:
    record = WarningRecord()
    assert record.take(warning(1.0, 0, 3000.0))
    assert not record.take(warning(2.0, 0, 3000.7))
    assert record.take(warning(3.0, 1, 3000.7))


@pytest.mark.parametrize(
    ("direction", "rpms"), [("run_up", (2999.0, 3001.0)), ("coast_down", (3001.0, 2999.0))]
)
def test_a_jump_is_met_where_the_expected_speed_is_passed(
    direction: str, rpms: tuple[float, float]
) -> None:
    record = WarningRecord()
    for time, level in ((0.5, 0), (1.0, 1), (2.0, 0), (3.0, 1), (4.5, 2)):
        record.take(warning(time, level, 3000.0, direction))
    record.follow(at(rpms[0], 0.7, time=5.0))
    record.take(warning(5.99, 0, math.inf, direction))  # of the point at 5.98 s
    assert record.jumps == []
    record.follow(at(rpms[1], 0.3, time=5.98))
    [jump] = record.jumps
    assert (jump.before, jump.after) == (0.7, 0.3)
    assert jump.ahead == pytest.approx(2.98)


def test_a_jump_is_met_though_a_prediction_behind_it_has_not_come() -> None:
    """That one has already led to another warning before the next prediction."""
    record = WarningRecord()
    record.take(warning(1.0, 1, 3000.0))
    record.follow(at(2995.0, 0.7, time=2.0))
    record.take(warning(2.03, 0, math.inf))  # of a prediction at 3001 rpm and 2.02 s
    record.follow(at(3005.0, 0.3, time=2.04))
    record.follow(at(3010.0, 0.3, time=2.06))
    [jump] = record.jumps
    assert (jump.before, jump.after, jump.warning.rpm) == (0.7, 0.3, 3000.0)
    assert jump.ahead == pytest.approx(1.04)


def test_no_jump_is_met_in_the_other_direction_or_unwarned() -> None:
    record = WarningRecord()
    record.take(warning(1.0, 0, 3000.0, "run_up"))
    for rpm, time in ((3001.0, 2.0), (2999.0, 3.0), (3001.0, 4.0)):
        record.follow(at(rpm, 0.5, time))
    [jump] = record.jumps
    assert jump.after == 0.5
    assert math.isnan(jump.ahead)
    assert "jump at 3000 rpm on the way up: eccentricity 0.5000 to 0.5000, not warned" in summary(
        RunRecord(), record
    )


def test_no_jump_is_met_at_a_wrong_speed() -> None:
    record = WarningRecord()
    record.take(warning(1.0, 0, 3000.0, "run_up"))
    for rpm, time in ((2000.0, 2.0), (4000.0, 2.02), (2001.0, 2.04)):
        record.follow(at(rpm, 0.5, time))
    assert record.jumps == []
    record.follow(at(3001.0, 0.5, 3.0))
    assert len(record.jumps) == 1


def test_summary_names_peaks_differences_and_jumps() -> None:
    record = recorded((1000, 0.1), (2000, 0.5), (3000, 0.2), (2000, 0.6), (1000, 0.1))
    record.speeds = 7
    warnings = WarningRecord()
    warnings.take(warning(1.0, 1, 2500.0, "coast_down"))
    warnings.follow(at(2600.0, 0.2, time=4.0))
    warnings.follow(at(2400.0, 0.6, time=4.5))
    assert summary(record, warnings).splitlines() == [
        "7 speeds, 5 predictions, 0 of them without a solution",
        "damper_1, on the way up: peak eccentricity 0.5000 at 2000 rpm",
        "damper_1, on the way down: peak eccentricity 0.6000 at 2000 rpm",
        "damper_1, up and down differ by at most 0.1000, at 2000 rpm",
        "damper_1, 5 measured orbits: 1x of x differs from the prediction by 2 % (median) and 2 % "
        "(99th percentile)",
        "jump at 2500 rpm on the way down: eccentricity 0.2000 to 0.6000, warned 3.5 s ahead",
    ]


def test_row_stands_under_the_header_with_a_dash_for_what_is_missing() -> None:
    row = rows(at(3000.0, 0.5, time=2.0), warning(1.5, 1, 3100.0))
    shown = ["50.00", "51.00", "0.25", "-", "3100", "2.5"]
    assert row.split() == ["2.0", "3000", "damper_1", "0.5000", "0.4500", *shown]
    titles = HEADER.splitlines()[1]
    values = {"[s]": "2.0", "[rpm]": "3000", "max": "0.5000", "other": "0.4500"}
    values |= {"1x": "50.00", "measured": "51.00", "2x": "0.25", "in [s]": "2.5"}
    for title, value in values.items():
        assert titles.index(title) + len(title) == row.rindex(value) + len(value)
    assert max(len(row), len(titles)) < 100


@pytest.mark.parametrize(("rpm", "shown"), [(math.inf, "-"), (math.nan, "?")])
def test_no_jump_ahead_is_told_from_an_unknown_one(rpm: float, shown: str) -> None:
    assert rows(at(3000.0, 0.5), warning(0.0, 0, rpm)).split()[-2] == shown


def test_every_damper_has_a_row_and_a_speed_alone_too() -> None:
    point = DamperPoint(math.nan, math.nan, ())
    lines = rows(RunPoint(0, 2.0, 3000.0, {"a": point, "b": point})).splitlines()
    assert [line.split()[:4] for line in lines] == [["2.0", "3000", name, "nan"] for name in "ab"]
    assert rows(RunPoint(0, 2.0, 3000.0)).split() == ["2.0", "3000", "no", "prediction"]


@pytest.mark.parametrize(("level", "word"), [(1, "WARN"), (2, "ERROR"), (9, "unknown")])
def test_diagnosis_names_the_level(level: int, word: str) -> None:
    assert diagnosis("predictor: Solver", level, "so").strip() == f"predictor: Solver {word}: so"


def test_a_long_warning_fits_on_a_terminal() -> None:
    long = JumpWarning(0, 1, "expected " * 30, "run_up", 3000.0, 3.0)
    lines = alarm(long).splitlines()
    assert len(lines) > 2
    assert max(map(len, lines)) < 100
    assert lines[0].strip().startswith("=> WARN: expected")
