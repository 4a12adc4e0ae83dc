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
