"""What the predictor keeps over a restart and what it gives up with its machine."""

import signal
from dataclasses import replace

import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import Load, read_machine

from .graph import LATCHED, PointCloud2, Remote
from .process import PAPER_ROTOR

SPEED = 370.0  # rad/s, where there is a single response
FORCE = (40.0, -90.0)  # N on disk_3


def parameters(**values):
    given = {
        "machine_file": PAPER_ROTOR,
        "harmonics": 1,
        "stale_after": 3600.0,
        "speed.min": 350.0,
        "speed.max": 390.0,
        "curve.detached": "false",
        **values,
    }
    return [part for key, value in given.items() for part in ("-p", f"{key}:={value}")]


def test_load_that_came_outlives_sigkill(graph, start, tmp_path):
    loaded = replace(read_machine(PAPER_ROTOR), loads=(Load("disk_3", FORCE),))
    motion = solve(HarmonicBalance(loaded, Harmonics(1)), SPEED).journals["damper_1"]
    expected = motion.coefficients[0] / motion.clearance
    assert abs(expected).min() > 1e-3
    file = tmp_path / "state.json"
    process = start(*parameters(state_file=file), "-r", "__node:=loaded")
    remote = Remote(graph, "/loaded")
    remote.meet(SPEED)
    remote.push("disk_3", FORCE, remote.now())
    graph.until(lambda: file.exists() and '"disk_3"' in file.read_text(), "the load is saved",
                lambda: remote.send(SPEED, remote.now()))  # fmt: skip
    assert process.stop(signal.SIGKILL) == -signal.SIGKILL
    start(*parameters(state_file=file), "-r", "__node:=loaded")
    again = Remote(graph, "/loaded")
    again.meet(SPEED)
    eccentricity, _ = again.predict(SPEED)
    found = [eccentricity[f"damper_1/static_{axis}"] for axis in "xy"]
    assert found == pytest.approx(expected, abs=1e-6)


def test_curve_is_withdrawn_with_its_machine(graph, start):
    start(*parameters(), "-r", "__node:=withdrawn")
    remote = Remote(graph, "/withdrawn")
    remote.meet(SPEED)
    graph.until(lambda: remote.curves and remote.curves[-1].width, "a curve comes")
    assert remote.change_state("deactivate", "cleanup") == [True, True]
    graph.until(lambda: remote.curves[-1].width == 0, "it is withdrawn")
    late: list[PointCloud2] = []
    graph.collect(PointCloud2, "/withdrawn/response_curve", late.append, LATCHED)
    graph.until(lambda: late, "who comes later hears of it")
    assert [message.width for message in late] == [0]
    assert remote.change_state("configure", "activate") == [True, True]
    graph.until(lambda: remote.curves[-1].width, "another curve comes")
