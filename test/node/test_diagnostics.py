"""What the node says about itself, in which order of precedence."""

import math

import pytest

from sfd_hbm_ros.kernels import load_kernels
from sfd_hbm_ros.machine import override_all, read_machine
from sfd_hbm_ros.node.diagnostics import (
    RECENT,
    Level,
    Levels,
    Status,
    inputs_status,
    model_status,
    solver_status,
)
from sfd_hbm_ros.node.inputs import Drops, Feed
from sfd_hbm_ros.node.prediction import Model, Prediction
from sfd_hbm_ros.units import RPM

from .process import PAPER_ROTOR

SECOND = 10**9


@pytest.fixture
def speed() -> Feed[float]:
    return Feed("~/speed")


def status(speed: Feed[float], *others: Drops, active: bool = True, now: float = 0.0) -> Status:
    return inputs_status(active, speed, others, stale_after=1.0, now=now)


def test_inputs_wait_arrive_and_grow_stale(speed):
    assert status(speed).level == Level.WARN
    assert status(speed).message == "waiting for the first message on ~/speed"
    assert status(speed, active=False).level == Level.OK
    speed.accept(300.0, SECOND, SECOND, now=10.0)
    assert status(speed, now=11.0).level == Level.OK
    assert status(speed, now=11.5).level == Level.ERROR
    assert "stale, its last message came 1.5 s ago" in status(speed, now=11.5).message


def test_a_speed_whose_stamp_lags_is_warned_of(speed):
    speed.accept(300.0, SECOND, 2 * SECOND, now=10.0)
    assert status(speed, now=10.0).level == Level.OK
    speed.accept(300.0, SECOND, 3 * SECOND, now=11.0)
    late = status(speed, now=11.0)
    assert late.level == Level.WARN
    assert late.message.startswith("~/speed arrives late, its last stamp was 2.0 s old")


def test_what_was_dropped_is_told_for_a_while_and_counted_for_ever(speed):
    load: Feed[float] = Feed("~/load")
    speed.accept(300.0, SECOND, SECOND, now=10.0)
    speed.drop("no speed", now=9.0)
    load.drop("no load", now=9.5)
    told = status(speed, load, now=10.0)
    assert told.level == Level.WARN
    assert told.message == "~/speed arrives; dropped from ~/load: no load"
    speed.accept(300.0, SECOND, SECOND, now=20.0)
    later = status(speed, load, now=9.5 + 2 * RECENT)
    assert later.level == Level.OK
    assert later.values["~/load: dropped"] == later.values["~/speed: dropped"] == "1"
    assert later.values["~/load: last dropped"] == "no load"


def test_a_drop_does_not_hide_that_the_speed_is_stale(speed):
    speed.accept(300.0, SECOND, SECOND, now=1.0)
    speed.drop("no speed", now=3.0)
    assert status(speed, now=3.0).level == Level.ERROR


def test_solver_tells_a_failure_and_none_at_rest():
    assert solver_status(None, 0, 0).level == Level.OK
    at_rest = Prediction(0.0, {}, False, "at rest")
    assert solver_status(at_rest, 1, 0).level == Level.OK
    failed = solver_status(Prediction(300.0, {}, True, "no way", 0.5, 40, 0.02), 7, 3)
    assert (failed.level, failed.message) == (Level.ERROR, "no way")
    assert failed.values == {
        "predictions": "7",
        "failures": "3",
        "speed [rad/s]": "300",
        "residual [of the load]": "0.5",
        "iterations": "40",
        "time [ms]": "20",
        "truncation error [of the clearance]": "nan",
    }


def test_solver_warns_of_harmonics_that_are_too_few():
    """A soft spring under gravity: 3 harmonics leave a thousandth of the clearance, 11 do not."""
    soft = {"gravity": True, "dampers.damper_1.centering_stiffness": 2.627e5}
    machine = override_all(read_machine(PAPER_ROTOR), soft)
    load_kernels()  # which takes longer than a prediction may
    few, enough = (
        solver_status(Model(machine, highest).predict(2000.0 * RPM), 1, 0) for highest in (3, 11)
    )
    key = "truncation error [of the clearance]"
    assert few.level == Level.WARN
    assert "more harmonics would move the orbit by 0.001 of the clearance" in few.message
    assert float(few.values[key]) > 1e-3 > 1e-5 > float(enough.values[key])
    assert enough.level == Level.OK


def test_model_tells_why_there_is_none():
    assert model_status("unconfigured", "", "", None).level == Level.OK
    bad = model_status("unconfigured", "clearance must be positive", "a.yaml", None)
    assert (bad.level, bad.message) == (Level.ERROR, "clearance must be positive")


def test_worsening_is_against_what_was_published():
    levels = Levels()
    assert not levels.worsened([Status("Solver", Level.OK, "")])
    warning = [Status("Solver", Level.WARN, ""), Status("Inputs", Level.OK, "")]
    assert levels.worsened(warning)
    levels.publish(warning)
    assert not levels.worsened(warning)
    assert levels.worsened([Status("Solver", Level.OK, ""), Status("Inputs", Level.WARN, "")])
    levels.publish([Status("Solver", Level.OK, "")])
    assert levels.worsened(warning)


def test_ages_that_do_not_exist_are_infinite(speed):
    assert float(status(speed).values["~/speed: age [s]"]) == math.inf
