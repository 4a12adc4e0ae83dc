"""A machine that leaves its response curve, through the node.

The paper's rotor with 503.9 g mm on disk 2 jumps at about 4160 rpm on the way up; its curve ends
at 3820 rpm, as its file gives that for its highest operating speed.
"""

import pytest

from .graph import Remote  # first, as it skips the file without ROS

# isort: split
from dataclasses import replace

from sfd_hbm_ros.machine import override_all, read_machine, write_machine

from .bistable import CURVE, settle_at
from .process import PAPER_ROTOR
from .test_watch import GIVEN, OK, RPM, UNBALANCE, WARN

LOWEST, HIGHEST = 350.0, 400.0  # rad/s
OPERATING = LOWEST / RPM, HIGHEST / RPM


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    machine = override_all(read_machine(PAPER_ROTOR), UNBALANCE)
    file = tmp_path_factory.mktemp("machine") / "machine.yaml"
    write_machine(replace(machine, operating_speed_rpm=OPERATING), file)
    values = {**GIVEN, "machine_file": file, "stale_after": 60.0}
    del values["speed.min"], values["speed.max"]
    start(*(part for name, value in values.items() for part in ("-p", f"{name}:={value}")))
    remote = Remote(graph)
    remote.meet(370.0)
    settle_at(remote, 370.0)
    return remote


def test_the_operating_range_is_that_of_the_curve(predictor):
    near = [pytest.approx(LOWEST), pytest.approx(HIGHEST)]
    assert predictor.get("speed.min", "speed.max") == near
    predictor.until_warning(OK, "No jump ahead from 3342 to 3820 rpm", 370.0)
    speeds = {"speed.min": 360.0, "speed.max": 390.0}
    assert predictor.set(speeds).successful
    assert predictor.change_state("deactivate", "cleanup") == [True, True]
    assert predictor.get("speed.min", "speed.max") == [360.0, 390.0]  # as somebody chose it
    assert predictor.set({"speed.min": LOWEST, "speed.max": HIGHEST}).successful
    assert predictor.change_state("configure", "activate") == [True, True]
    predictor.until_warning(OK, "No jump ahead from 3342 to 3820 rpm", 370.0)


def test_a_speed_in_rpm_is_doubted_in_words(predictor):
    def between() -> None:
        predictor.send(3500.0, predictor.now())

    status = predictor.until_status("Inputs", WARN, "were 3500 rpm meant", between)
    assert "3500 rad/s are 33423 rpm" in status.message
    assert "above the response curve, which ends at 3820 rpm" in status.message
    assert predictor.get("speed.max") == [pytest.approx(HIGHEST)]
    predictor.until_status("Inputs", OK, "arrives", lambda: predictor.send(370.0, predictor.now()))


def test_beyond_the_curve_it_warns_and_the_curve_follows(predictor):
    settle_at(predictor, 370.0)
    number, said = len(predictor.curves), len(predictor.warnings)
    predictor.until_warning(WARN, "above the response curve, which ends at 3820 rpm", 405.0)
    predictor.until_status(
        "Inputs", WARN, "ends at 3820 rpm", lambda: predictor.send(405.0, predictor.now())
    )
    predictor.graph.until(
        lambda: len(predictor.curves) > number,
        "a wider curve comes",
        lambda: predictor.send(405.0, predictor.now()),
        CURVE,
    )
    values = predictor.until_warning(OK, "expected at 4160 rpm", 405.0)
    # The machine is as it was: that a wider curve is wanted makes none of this one outdated.
    assert not any("outdated" in status.message for _, status in predictor.warnings[said:])
    assert float(values["next_jump_rpm"]) == pytest.approx(4160.0, abs=1.0)
    assert predictor.get("speed.max") == [pytest.approx(HIGHEST)]
