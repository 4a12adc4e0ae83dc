"""What the predictor keeps over a restart and what it gives up with its machine."""

import math
import signal
from dataclasses import replace

import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import Load, override, read_machine
from sfd_hbm_ros.response.tracking.state_file import load_state, save_state

from .graph import LATCHED, PointCloud2, Remote, strings
from .process import PAPER_ROTOR

SPEED = 370.0  # rad/s, where there is a single response
CURVE = 240.0  # s, within which a response curve comes on a busy computer
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


def test_a_jump_is_told_and_outlives_sigkill_but_not_any_age(graph, start, tmp_path):
    """The paper's rotor with 503.9 g mm jumps at 4160 rpm on the way up, and is bistable below."""
    file, rpm = tmp_path / "state.json", math.pi / 30.0
    heavy = {"unbalance.disk_2.magnitude": 5.039e-4, "speed.max": 450.0}
    given = *parameters(state_file=file, **heavy), "-r", "__node:=jumping"
    machine = override(read_machine(PAPER_ROTOR), "unbalance.disk_2.magnitude", 5.039e-4)
    process = start(*given)
    remote = Remote(graph, "/jumping")
    remote.meet(SPEED)
    graph.until(lambda: remote.curves, "a curve", lambda: remote.predict(SPEED), limit=CURVE)
    for speed in (4000.0, 4100.0, 4150.0, 4170.0):
        remote.predict(speed * rpm)

    def bistable() -> None:
        remote.send(4100.0 * rpm, remote.now())

    def told() -> bool:
        return "damper_1 jumped down at 4160 rpm, 0.9" in remote.warnings[-1][1].message

    graph.until(told, "the jump is told")
    graph.until(lambda: load_state(file, machine).jumps.get("count") == 1, "it is saved at once")
    assert load_state(file, machine).speed > 4160.0 * rpm  # with where it landed
    process.stop(signal.SIGKILL)

    process = start(*given)
    remote.warnings.clear()
    values = {}

    def lower() -> bool:
        values.update(strings(remote.warnings[-1][1]) if remote.warnings else {})
        return values.get("branch") == "lower"

    graph.until(lower, "the branch is known", bistable, limit=CURVE)
    assert told()
    assert values["jumps"] == "1"
    assert "Z damper_1 jumped down at 4160 rpm" in values["last_jumps"]
    assert remote.order("acknowledge") == (True, "acknowledged")
    graph.until(lambda: load_state(file, machine).jumps["unseen"] == 0, "it is saved")
    process.stop(signal.SIGKILL)

    save_state(file, machine, replace(load_state(file, machine), stamp=31_536_000_000_000_000))
    start(*given)
    remote.warnings.clear()
    message = ""

    def unknown() -> bool:
        nonlocal message
        message = remote.warnings[-1][1].message if remote.warnings else ""
        return "on which of 2 responses the machine is" in message

    graph.until(unknown, "1971 is too long ago", bistable, limit=CURVE)
    assert "jumped" not in message  # as it was acknowledged
    assert strings(remote.warnings[-1][1])["jumps"] == "1"
    remote.until_status("Model", b"\x01", "days ago, longer than state_max_age, 120 s")
