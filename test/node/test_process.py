"""The predictor as a process: its start, its end, its names and its parameter file."""

import signal
import time

import pytest
import yaml

from .graph import Remote
from .process import PAPER_ROTOR, ROOT, parameters_of

OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_it_cleanly_while_it_predicts(graph, start, number):
    name = f"predictor_{number.name.lower()}"
    process = start("-p", f"machine_file:={PAPER_ROTOR}", "-r", f"__node:={name}")
    remote = Remote(graph, f"/{name}")
    remote.meet()
    for i in range(50):
        remote.send(300.0 + i, remote.now())
    begin = time.monotonic()
    assert process.stop(number) == 0, process.said()
    assert time.monotonic() - begin < 5.0
    assert "Traceback" not in process.said()


def test_bad_arguments_end_it_with_a_sentence(start):
    process = start("-p", "harmonics:=")
    assert process.wait(20.0) == 2
    assert "predictor: bad ROS arguments" in process.said()
    assert "Traceback" not in process.said()


def test_namespace_remapping_and_parameter_file(graph, start):
    start(
        *("-r", "__ns:=/plant/turbine_2", "-r", "~/speed:=/tacho"),
        *("--params-file", str(ROOT / "config" / "predictor.yaml")),
        *("-p", f"machine_file:={PAPER_ROTOR}"),
    )
    remote = Remote(graph, "/plant/turbine_2/predictor", speed="/tacho")
    remote.meet()
    eccentricity, _ = remote.predict(300.0)
    assert 0.0 < eccentricity["damper_1/max"] < 1.0
    assert set(remote.statuses) == {"Jump", "Model", "Solver", "Inputs"}
    assert {status.hardware_id for status in remote.statuses.values()} == {"paper_rotor"}
    given = parameters_of(ROOT / "config" / "predictor.yaml")
    del given["machine_file"]
    assert remote.get(*given) == list(given.values())


def test_parameter_file_as_people_write_it(graph, start, tmp_path):
    file = tmp_path / "parameters.yaml"
    dampers = {"damper_1": {"viscosity": 1, "viscosty": 0.03}}
    given = {
        "machine_file": str(PAPER_ROTOR),
        "publish_rate": 50,
        "harmoncis": 5,
        "stations": [],
        "dampers": dampers,
    }
    file.write_text(yaml.safe_dump({"/**": {"ros__parameters": given}}))
    process = start("--params-file", str(file), "-r", "__node:=written")
    remote = Remote(graph, "/written")
    remote.meet()
    assert remote.get("publish_rate", "dampers.damper_1.viscosity") == [50.0, 1.0]
    said = process.said()
    assert "parameter harmoncis is unknown (did you mean harmonics?)" in said
    assert "parameter stations is unknown" in said
    assert "(did you mean dampers.damper_1.viscosity?)" in said


def test_bad_machine_file_and_parameter_can_be_amended(graph, start, tmp_path):
    bad = tmp_path / "bad.yaml"
    bad.write_text(PAPER_ROTOR.read_text().replace("clearance: 2.54e-4", "clearance: .nan"))
    process = start(
        *("-p", f"machine_file:={bad}", "-p", "harmonics:=0", "-r", "__node:=amended"),
        *("-p", f"machine_folder:={PAPER_ROTOR.parent}"),
    )
    remote = Remote(graph, "/amended")
    remote.until_status("Model", ERROR, "harmonics must be an integer from 1 to 31, not 0")
    assert remote.state() == "unconfigured"
    assert remote.set({"harmonics": 5}).successful
    assert remote.change_state("configure") == [False]
    clearance = f"{bad}: dampers.damper_1.clearance must be"
    remote.until_status("Model", ERROR, clearance)
    assert process.said().count(clearance) == 1
    assert remote.set({"machine_file": str(PAPER_ROTOR)}).successful
    assert remote.change_state("configure", "activate") == [True, True]
    remote.meet()
    _, harmonics = remote.predict(300.0)
    assert "damper_1/y/5x/phase" in harmonics
    assert "damper_1/y/6x/phase" not in harmonics


def test_without_autostart_it_waits_and_beats(graph, start):
    start(
        *("-p", f"machine_file:={PAPER_ROTOR}", "-p", "autostart:=false"),
        *("-r", "__node:=patient"),
    )
    remote = Remote(graph, "/patient")
    remote.until_status("Model", OK, "unconfigured")
    remote.beats()
    assert remote.state() == "unconfigured"
    assert remote.change_state("configure", "activate") == [True, True]
    remote.meet()
