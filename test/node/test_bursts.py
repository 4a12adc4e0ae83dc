"""Speeds that come late, and thousands of messages at once."""

import pytest

from .graph import Remote, numbers  # first of these, as it skips the file without ROS

# isort: split
from .bistable import RPM, UPPER_ONLY, begin, orbits

OK, WARN = b"\x00", b"\x01"
SECOND = 10**9
SPEEDS = 5000
LOADS = 2000


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    return begin(start, graph, tmp_path_factory.mktemp("machine"), UPPER_ONLY)


def test_late_speeds_are_predicted_and_warned_of(predictor):
    assert predictor.set({"stale_after": 2.0}).successful
    predictor.restart()
    late = predictor.now() - 5 * SECOND
    eccentricity, _ = predictor.predict(UPPER_ONLY, late)
    assert eccentricity["damper_1/max"] == pytest.approx(orbits(UPPER_ONLY)[0], abs=1e-8)
    said = "/predictor/speed arrives late, its last stamp was 5."
    predictor.until_status("Inputs", WARN, said)

    def again() -> None:
        predictor.send(UPPER_ONLY, predictor.now())

    predictor.until_status("Inputs", OK, "/predictor/speed arrives", again)
    assert predictor.set({"stale_after": 60.0}).successful


def test_of_a_burst_the_newest_speed_is_predicted(predictor):
    predictor.eccentricity.clear()
    sent = {}
    for i in range(SPEEDS):
        stamp = predictor.now()
        sent[stamp] = (3860.0 + i % 100) * RPM
        predictor.send(sent[stamp], stamp)
    last = predictor.now()
    sent[last] = UPPER_ONLY
    predictor.graph.until(
        lambda: last in predictor.eccentricity,
        "the newest is predicted",
        between=lambda: predictor.send(UPPER_ONLY, last),
    )
    stamps = [stamp for stamp in predictor.eccentricity if stamp in sent]
    assert stamps == sorted(stamps)
    assert len(stamps) < SPEEDS / 2
    for stamp in stamps:
        [right] = orbits(sent[stamp])
        value = numbers(predictor.eccentricity[stamp])["damper_1/max"]
        assert value == pytest.approx(right, abs=1e-8)


def test_of_a_burst_of_loads_the_newest_acts(predictor):
    predictor.predict(UPPER_ONLY)
    predictor.eccentricity.clear()
    for i in range(LOADS):
        predictor.push("disk_3", (0.0, -float(i)), predictor.now())
    last = predictor.now()
    predictor.push("disk_3", (0.0, 0.0), last)
    eccentricity, _ = predictor.answer(last)
    assert eccentricity["damper_1/max"] == pytest.approx(orbits(UPPER_ONLY)[0], abs=1e-8)
    stamps = list(predictor.eccentricity)
    assert stamps == sorted(stamps)
    assert len(stamps) < LOADS / 2
