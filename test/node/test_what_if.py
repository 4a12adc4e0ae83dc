"""Questions about other speeds: closed-form answers, and predictions that go on undisturbed."""

import math

import pytest

from .graph import JointState, Remote  # first, as it skips the file without ROS

# isort: split
from sfd_hbm_ros.node.what_if import MOST_WAITING

from .bistable import (
    BOTH,
    LIGHT,
    LOWER_ONLY,
    UPPER_ONLY,
    Topics,
    begin,
    changed,
    orbits,
    settle_at,
)

WARN = b"\x01"
NAN = pytest.approx(math.nan, nan_ok=True)
OUTSIDE = 700.0  # rad/s, beyond the range of the curve


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    return begin(start, graph, tmp_path_factory.mktemp("machine"), UPPER_ONLY)


@pytest.fixture(scope="module")
def what_if(predictor) -> Topics:
    return Topics(predictor, "what_if/request", "what_if/result")


def read(answer: JointState) -> list[tuple[float, float, float]]:
    """Speed, greatest eccentricity and that of the other branch, for each speed asked about."""
    rows = list(zip(answer.name, answer.position, answer.velocity, strict=True))
    own = [(speed, value) for name, value, speed in rows if name == "damper_1/max"]
    other = [value for name, value, _ in rows if name == "damper_1/other_branch/max"]
    return [(*pair, value) for pair, value in zip(own, other, strict=True)]


def near(value: float) -> object:
    return pytest.approx(value, abs=1e-8)


def test_answers_are_journeys_from_the_present_state(predictor, what_if):
    for here, place in ((UPPER_ONLY, 1), (LOWER_ONLY, 0)):
        before = settle_at(predictor, here)
        asked = [BOTH, LOWER_ONLY, OUTSIDE, UPPER_ONLY, BOTH]
        answer = what_if.ask(predictor.now(), velocity=asked)
        both = orbits(BOTH)
        [lower], [upper] = orbits(LOWER_ONLY), orbits(UPPER_ONLY)
        middle = (BOTH, near(both[place]), near(both[1 - place]))
        assert read(answer) == [
            middle,
            (LOWER_ONLY, near(lower), NAN),
            (OUTSIDE, NAN, NAN),
            (UPPER_ONLY, near(upper), NAN),
            middle,
        ]
        assert [name for name in answer.name if name.startswith("reason: ")] == [
            "reason: no journey along the response curve leads there"
        ]
        assert predictor.predict(here)[0] == pytest.approx(before, rel=1e-9, nan_ok=True)


def test_a_question_after_a_change_waits_for_the_curve_of_the_new_machine(predictor, what_if):
    settle_at(predictor, UPPER_ONLY)
    path = "unbalance.disk_1.magnitude"
    assert predictor.set({path: LIGHT}).successful
    try:
        [(_, own, other)] = read(what_if.ask(predictor.now(), velocity=[BOTH]))
        [single] = orbits(BOTH, changed(path, LIGHT))
        assert (own, other) == (near(single), NAN)
    finally:
        predictor.restart()


def test_questions_leave_room_for_predictions_and_too_many_are_refused(predictor, what_if):
    settle_at(predictor, UPPER_ONLY)
    long = predictor.now()
    what_if.send(long, velocity=[BOTH] * 500)
    stamps = []
    for _ in range(MOST_WAITING + 2):  # one by one: each is taken before the next is sent
        stamps.append(predictor.now())
        what_if.send(stamps[-1], velocity=[BOTH])
        predictor.predict(UPPER_ONLY)
    assert long not in what_if.answers
    predictor.until_status("Inputs", WARN, f"{MOST_WAITING} questions are waiting already")
    predictor.until_dropped("/predictor/what_if/request", 1)
    for stamp in (long, *stamps[: MOST_WAITING - 1]):
        predictor.graph.until(lambda stamp=stamp: stamp in what_if.answers, "an answer")


@pytest.mark.parametrize(
    ("velocity", "reason"),
    [
        ([], "velocity must hold 1 to 1000 rotor speeds"),
        ([400.0, -1.0], "above 0, not -1.0"),
        ([math.nan], "above 0, not nan"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(predictor, what_if, velocity, reason):
    stamp = predictor.now()
    answer = what_if.ask(stamp, velocity=velocity)
    assert any(name.startswith("reason: ") and reason in name for name in answer.name)
    assert all(math.isnan(value) for value in answer.position)
    predictor.until_status("Inputs", WARN, reason)


def test_an_inactive_node_refuses_questions(predictor, what_if):
    assert predictor.change_state("deactivate") == [True]
    answer = what_if.ask(predictor.now(), velocity=[BOTH, UPPER_ONLY])
    assert "reason: the node is not active" in answer.name
    assert read(answer) == [(BOTH, NAN, NAN), (UPPER_ONLY, NAN, NAN)]
    predictor.until_status("Inputs", WARN, "the node is not active")
    assert predictor.change_state("activate") == [True]
    settle_at(predictor, UPPER_ONLY)
    assert len(read(what_if.ask(predictor.now(), velocity=[BOTH]))) == 1
