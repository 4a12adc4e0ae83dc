"""The model that predicts: loads, changes and failures, without ROS."""

from dataclasses import replace

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import Load, Machine, MachineError, override, read_machine
from sfd_hbm_ros.node.prediction import AT_REST, Model

from .process import PAPER_ROTOR

PAPER = read_machine(PAPER_ROTOR)


def expected(machine: Machine, speed: float, k: int = 3) -> np.ndarray:
    return solve(HarmonicBalance(machine, Harmonics(k)), speed).coefficients


def predicted(model: Model, speed: float) -> np.ndarray:
    prediction = model.predict(speed)
    assert not prediction.failed
    return prediction.journals["damper_1"].coefficients


def test_topic_loads_replace_the_files_at_their_station_alone():
    machine = replace(PAPER, loads=(Load("disk_1", (0, -50)), Load("disk_3", (0, -70))))
    model = Model(machine, 3)
    model.add(model.checked_load("disk_3", (20.0, -90.0)))
    both = replace(PAPER, loads=(Load("disk_1", (0, -50)), Load("disk_3", (20, -90))))
    np.testing.assert_allclose(predicted(model, 300.0), expected(both, 300.0), atol=1e-15)


def test_a_refused_load_changes_nothing():
    model = Model(PAPER, 3)
    for station, force, reason in (
        ("disk_9", (0.0, 0.0), "disk_1, disk_2, disk_3, bearing_1, damper_1"),
        ("disk_3", (0.0, float("nan")), r"loads.disk_3.force must be .* \[N\]"),
    ):
        with pytest.raises(MachineError, match=reason):
            model.checked_load(station, force)
    np.testing.assert_array_equal(predicted(model, 300.0), expected(PAPER, 300.0))


def test_loads_outlast_a_change_of_the_machine():
    model = Model(PAPER, 3)
    model.add(model.checked_load("disk_3", (0.0, -90.0)))
    changed = override(PAPER, "dampers.damper_1.viscosity", 0.02)
    model.change(changed, 4)
    loaded = replace(changed, loads=(Load("disk_3", (0, -90)),))
    np.testing.assert_allclose(predicted(model, 300.0), expected(loaded, 300.0, 4), atol=1e-15)


def test_the_same_load_again_changes_nothing():
    model = Model(PAPER, 3)
    load = model.checked_load("disk_3", (0.0, -90.0))
    assert model.add(load)
    assert not model.add(load)
    assert model.add(model.checked_load("disk_3", (0.0, -91.0)))


def test_the_last_solution_is_the_start():
    model = Model(PAPER, 3)
    assert model.predict(300.0).iterations > 0
    assert model.predict(300.0).iterations == 0


def test_failures_are_told_and_leave_no_trace():
    model = Model(PAPER, 3)
    failure = model.predict(1e200)
    assert failure.failed
    assert "the solver gave up: " in failure.message
    assert np.isnan(failure.journals["damper_1"].coefficients).all()
    np.testing.assert_array_equal(predicted(model, 300.0), expected(PAPER, 300.0))


def test_at_rest_there_is_nothing_to_predict():
    rest = Model(PAPER, 3).predict(0.0)
    assert (rest.failed, rest.message) == (False, AT_REST)
    assert np.isnan(rest.journals["damper_1"].eccentricity_max)
