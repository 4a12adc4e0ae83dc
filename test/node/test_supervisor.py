"""The example of a supervisory node, run beside a predictor as its user runs it."""

import re

import pytest

from .graph import Remote  # first, as it skips the file without ROS

# isort: split
from .bistable import BOTH, LIGHT, RPM, UPPER_ONLY, begin, changed, orbits, settle_at

OK = b"\x00"
LIMIT = 120.0  # s
UNBALANCE = "unbalance.disk_1.magnitude"


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    remote = begin(start, graph, tmp_path_factory.mktemp("machine"), UPPER_ONLY)
    settle_at(remote, UPPER_ONLY)
    return remote


def supervise(start_node, *parameters: str, namespace: str = "/") -> tuple[int, str]:
    """Run it to its end; return its exit code and what it said."""
    given = (f"rpm:={BOTH / RPM}", *parameters)
    arguments = ["-r", f"__ns:={namespace}", *(part for one in given for part in ("-p", one))]
    supervisor = start_node("supervisor", "--ros-args", *arguments)
    code = supervisor.wait(LIMIT)
    return code, supervisor.said()


def test_all_steps_are_gone_through(predictor, start_node):
    code, said = supervise(start_node, "station:=disk_1", f"magnitude:={LIGHT}", "phase:=0.5")
    assert code == 0, said
    assert predictor.get(UNBALANCE, "unbalance.disk_1.phase") == [LIGHT, 0.5]
    [single] = orbits(BOTH, changed(UNBALANCE, LIGHT))
    [answered] = re.findall(r"damper_1/max would be (\S+) of the clearance", said)
    assert float(answered) == pytest.approx(single, abs=5e-4)
    assert "damper_1/other_branch/max would be nan" in said
    assert re.search(r"its response curve has \d+ points", said)
    assert "the alarm: " in said


def test_what_is_set_already_needs_no_new_curve(predictor, start_node):
    magnitude, phase = predictor.get(UNBALANCE, "unbalance.disk_1.phase")
    given = f"magnitude:={magnitude}", f"phase:={phase}"
    number = len(predictor.curves)
    code, said = supervise(start_node, "station:=disk_1", *given)
    assert code == 0, said
    assert re.search(r"its response curve has \d+ points", said)
    assert len(predictor.curves) == number
    values = predictor.until_warning(OK, speed=UPPER_ONLY)
    assert values["revision"] == values["curve_revision"]
    assert predictor.set({UNBALANCE: magnitude}).reason == f"revision {values['revision']}"
    changed = int(values["revision"]) + 1
    assert predictor.set({UNBALANCE: 0.5 * LIGHT}).reason == f"revision {changed}"
    values = predictor.until_warning(OK, "outdated", UPPER_ONLY)
    assert int(values["revision"]) == changed > int(values["curve_revision"])


@pytest.mark.parametrize(
    ("parameter", "reason"),
    [
        ("station:=disk_9", "did you mean unbalance.disk_3.magnitude?"),
        ("magnitude:=-1.0", "unbalance.disk_1.magnitude must be"),
    ],
)
def test_a_refusal_ends_it_with_the_reason(predictor, start_node, parameter, reason):
    before = predictor.get(UNBALANCE)
    code, said = supervise(start_node, "station:=disk_1", parameter)
    assert code == 1
    assert "the unbalance is refused: " in said
    assert reason in said
    assert predictor.get(UNBALANCE) == before


def test_without_a_predictor_it_gives_up(start_node):
    code, said = supervise(start_node, "patience:=0.5", namespace="/nowhere")
    assert code == 1
    assert "waited 0.5 s for the predictor in vain" in said
