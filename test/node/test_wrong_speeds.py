"""Speeds over DDS that the machine never had: a pulse of the keyphasor was missed or doubled."""

import pytest

from .graph import Remote, strings  # first, as it skips the file without ROS

# isort: split
from .bistable import BOTH, LOWER_ONLY, UPPER_ONLY, begin, orbits, settle_at

WARN = b"\x01"
STEP = 20_000_000  # ns between two speeds


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    return begin(start, graph, tmp_path_factory.mktemp("machine"), UPPER_ONLY)


@pytest.mark.parametrize("wrong", [0.5, 2.0], ids=["half", "twice"])
@pytest.mark.parametrize(("side", "upper"), [(UPPER_ONLY, True), (LOWER_ONLY, False)])
def test_the_branch_is_kept(predictor, wrong, side, upper):
    settle_at(predictor, side)
    stamp = predictor.now()
    expected = pytest.approx(orbits(BOTH)[upper], abs=1e-8)
    assert predictor.predict(BOTH, stamp)[0]["damper_1/max"] == expected
    seen = len(predictor.warnings)
    assert predictor.predict(wrong * BOTH, stamp + STEP)[0]["damper_1/max"] != expected
    assert predictor.predict(BOTH, stamp + 2 * STEP)[0]["damper_1/max"] == expected
    told = {strings(status)["branch"] for _, status in predictor.warnings[seen:]}
    assert told <= {"upper" if upper else "lower"}  # and not that of the wrong speed
    predictor.until_status("Inputs", WARN, "a speed leapt away and was back at once")
    predictor.graph.until(lambda: predictor.now() > stamp + 2 * STEP, "these stamps have passed")


def test_a_speed_that_the_machine_cannot_have_is_dropped_and_blinds_nobody(predictor):
    """1e6 rad/s for longer than a wrong speed is held to be one, then the machine's again."""
    expected = pytest.approx(orbits(UPPER_ONLY)[0], abs=1e-8)
    assert predictor.predict(UPPER_ONLY)[0]["damper_1/max"] == expected
    dropped = drops(predictor)
    end = predictor.now() + 1_000_000_000
    predictor.graph.until(
        lambda: predictor.now() > end and drops(predictor) >= dropped + 5,
        "they are dropped",
        lambda: predictor.send(1e6, predictor.now()),
    )
    status = predictor.until_status("Inputs", WARN, "not 1e+06: the rim of disk_")
    assert " m/s" in status.message
    assert predictor.predict(UPPER_ONLY)[0]["damper_1/max"] == expected
    name = "dampers.damper_1.viscosity"
    [before] = predictor.get(name)
    assert not predictor.set({name: 1e300}).successful
    assert predictor.set({name: 1e5}).successful
    assert predictor.predict(UPPER_ONLY)[0]["damper_1/max"] < 0.01
    assert predictor.set({name: before}).successful
    assert predictor.predict(UPPER_ONLY)[0]["damper_1/max"] == expected


def drops(predictor: Remote) -> int:
    """How many speeds are said to have been dropped."""
    return int(strings(predictor.statuses["Inputs"])["/predictor/speed: dropped"])
