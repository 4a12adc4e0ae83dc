"""The state of a predictor written, read back, torn and refused."""

import errno
import json
import os
from dataclasses import replace

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override
from sfd_hbm_ros.response.tracking.state import State, from_plain, restore, to_plain
from sfd_hbm_ros.response.tracking.state_file import StateFileError, load_state, save_state

from ...hbm.machines import PAPER, random_machine

RPM = np.pi / 30.0
HARMONICS = Harmonics(2)
STATE = State(
    speed=3900.123456789 * RPM,
    harmonics=HARMONICS,
    coefficients=np.random.default_rng(7).normal(0.0, 1e-5, (HARMONICS.rows, 2)),
    settled=True,
    stamp=1_700_000_000_123_456_789,
    alarm={"latched": True, "since": 12.5, "note": "Öl"},
    loads={"disk_3": (0.0, -70.5)},
)


def equal(one, other):
    return one.coefficients.tolist() == other.coefficients.tolist() and all(
        getattr(one, name) == getattr(other, name)
        for name in ("speed", "harmonics", "settled", "stamp", "alarm", "loads")
    )


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "state.json"
    save_state(path, PAPER, STATE)
    return path


def test_state_comes_back_exactly_and_alone(path):
    assert equal(load_state(path, PAPER), STATE)
    assert os.listdir(path.parent) == ["state.json"]
    assert json.loads(path.read_text())["version"] == 1


def test_newer_state_replaces_the_older(path):
    save_state(path, PAPER, replace(STATE, stamp=5))
    assert load_state(path, PAPER).stamp == 5


def test_older_state_without_loads_is_read():
    plain = to_plain(STATE)
    del plain["loads"]
    assert equal(from_plain(plain), replace(STATE, loads={}))


@pytest.mark.parametrize("loads", [[1], {"disk_3": [1.0]}, {"disk_3": ["a", 0.0]}])
def test_loads_that_are_none_are_refused(loads):
    with pytest.raises((AttributeError, ValueError)):
        from_plain({**to_plain(STATE), "loads": loads})


def test_no_file_is_no_state(tmp_path):
    assert load_state(tmp_path / "none.json", PAPER) is None


def test_file_torn_at_any_byte_is_refused(path):
    whole = path.read_bytes()
    for length in range(len(whole) - 1):  # the last byte is but the end of the last line
        path.write_bytes(whole[:length])
        with pytest.raises(StateFileError, match=r"state\.json: refused: torn, "):
            load_state(path, PAPER)


def test_flipped_bits_are_refused_or_do_not_matter(path):
    whole = path.read_bytes()
    refused = 0
    for at in range(len(whole)):
        for bit in (1, 32, 128):
            path.write_bytes(whole[:at] + bytes([whole[at] ^ bit]) + whole[at + 1 :])
            try:
                assert equal(load_state(path, PAPER), STATE)
            except StateFileError as error:
                assert str(error).startswith(f"{path}: refused: ")  # noqa: PT017
                refused += 1
    assert refused > 2 * len(whole)


@pytest.mark.parametrize(
    "other",
    [
        random_machine(1),
        replace(PAPER, name="another rotor"),
        replace(PAPER, disks=(replace(PAPER.disks[0], node=9), *PAPER.disks[1:])),
    ],
    ids=["machine", "name", "node"],
)
def test_state_of_another_machine_is_refused(path, other):
    with pytest.raises(StateFileError, match="refused: foreign, the state of another machine"):
        load_state(path, other)


def test_numbers_of_the_machine_may_have_changed(path):
    changed = override(PAPER, "dampers.damper_1.viscosity", 0.02)
    assert equal(load_state(path, changed), STATE)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "torn, it is not whole JSON text"),
        ("[1, 2]", "not a state file"),
        ('{"format": "sfd_hbm_ros state", "version": 2}', "of version 2, not 1"),
        ("[" * 100_000, "torn, it is not whole JSON text"),
    ],
)
def test_other_files_are_refused(path, text, reason):
    path.write_text(text)
    with pytest.raises(StateFileError, match=f"refused: {reason}"):
        load_state(path, PAPER)


def test_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    os.symlink(os.devnull, tmp_path / "device")
    for path in (tmp_path, tmp_path / "pipe", tmp_path / "device"):
        before = os.stat(path)
        with pytest.raises(StateFileError, match="refused: not a regular file"):
            load_state(path, PAPER)
        with pytest.raises(StateFileError, match="cannot be written: not a regular file"):
            save_state(path, PAPER, STATE)
        assert os.path.samestat(os.stat(path), before)


def test_file_behind_a_link_is_replaced_and_not_the_link(path, tmp_path):
    link = tmp_path / "link.json"
    link.symlink_to(path)
    save_state(link, PAPER, replace(STATE, stamp=5))
    assert link.is_symlink()
    assert load_state(path, PAPER).stamp == 5


def test_folder_that_is_none_is_told(path):
    with pytest.raises(StateFileError, match="cannot be written: Not a directory"):
        save_state(path / "state.json", PAPER, STATE)
    with pytest.raises(StateFileError, match="refused: Not a directory"):
        load_state(path / "state.json", PAPER)


@pytest.mark.parametrize("call", ["replace", "fsync"])
def test_full_disk_is_told_and_leaves_the_older_state(path, monkeypatch, call):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, call, full)
    with pytest.raises(StateFileError, match="cannot be written: No space left on device"):
        save_state(path, PAPER, replace(STATE, stamp=5))
    monkeypatch.undo()
    assert equal(load_state(path, PAPER), STATE)
    assert os.listdir(path.parent) == ["state.json"]


@pytest.mark.parametrize("change", [{"alarm": {"at": {1}}}, {"speed": float("nan")}])
def test_what_json_cannot_hold_is_told(path, change):
    with pytest.raises(StateFileError, match="cannot be written: "):
        save_state(path, PAPER, replace(STATE, **change))
    assert equal(load_state(path, PAPER), STATE)


def test_branch_is_restored_exactly():
    """Both stable responses of a bistable speed come back, each as itself."""
    machine = override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4)
    balance = HarmonicBalance(machine, Harmonics(3))
    for start in (3700.0, 4300.0):
        solution = None
        for rpm in np.linspace(start, 4050.0, 40):
            solution = solve(balance, rpm * RPM, solution)
        state = State(solution.speed, solution.harmonics, solution.coefficients, True, 0, {})
        restored = restore(state, balance)
        assert restored.same
        difference = restored.solution.coefficients - solution.coefficients
        assert np.abs(difference / balance.clearances).max() < 1e-9


def test_response_that_is_gone_is_told():
    machine = override(PAPER, "unbalance.disk_2.magnitude", 5.039e-4)
    balance = HarmonicBalance(machine, Harmonics(1))
    coefficients = np.array([[0.0, 0.0], [2e-4, 0.0], [0.0, 2e-4]])
    restored = restore(State(3000.0 * RPM, Harmonics(1), coefficients, True, 0, {}), balance)
    assert restored.solution.converged
    assert not restored.same
