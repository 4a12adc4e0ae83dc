"""The state of a predictor written, read back, torn and refused."""

import errno
import json
import os
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override, safe_file
from sfd_hbm_ros.machine.safe_file import put_aside
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
        ('{"format": "sfd_hbm_ros state", "version": 2}', "of a version other than 1"),
        ("[" * 100_000, "torn, it is not whole JSON text"),
    ],
)
def test_other_files_are_refused(path, text, reason):
    path.write_text(text)
    with pytest.raises(StateFileError, match=f"refused: {reason}"):
        load_state(path, PAPER)


@pytest.mark.parametrize(
    "change",
    [
        {"samples": 10**9},
        {"samples": 64.0},
        {"highest": 10**9},
        {"revolutions": 10**9},
        {"multiples": [0, 0.5, 1]},
    ],
    ids=str,
)
def test_harmonics_that_would_fill_the_memory_are_refused(change):
    """A file with the right checksum may come from anybody."""
    plain = to_plain(STATE)
    with pytest.raises((ValueError, TypeError)):
        from_plain({**plain, "harmonics": {**plain["harmonics"], **change}})


def test_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", Path(os.devnull), Path("/"), Path(".."), Path("")):
        before = os.stat(path)
        with pytest.raises(StateFileError, match="refused: not a regular file"):
            load_state(path, PAPER)
        with pytest.raises(StateFileError, match="cannot be written: "):
            save_state(path, PAPER, STATE)
        assert os.path.samestat(os.stat(path), before)


@pytest.mark.parametrize("name", ["x" * 300, "a\0b", "\ud800"])
def test_names_that_no_file_can_have_are_told(tmp_path, name):
    with pytest.raises(StateFileError, match="cannot be written: "):
        save_state(tmp_path / name, PAPER, STATE)
    assert not os.listdir(tmp_path)


def test_no_link_is_followed(path, tmp_path):
    before = path.read_bytes()
    link = tmp_path / "link.json"
    link.symlink_to(path)
    with pytest.raises(StateFileError, match="refused: a link, which is not followed"):
        load_state(link, PAPER)
    with pytest.raises(StateFileError, match="cannot be written: a link, which is not followed"):
        save_state(link, PAPER, STATE)
    other = tmp_path / "other.json"
    (tmp_path / "other.json.part").symlink_to(path)
    with pytest.raises(StateFileError, match="cannot be written: a link, which is not followed"):
        save_state(other, PAPER, STATE)
    assert not other.exists()
    assert link.is_symlink()
    assert path.read_bytes() == before


@pytest.mark.parametrize("name", ["state.json", "state.json.part"])
def test_nothing_is_replaced_that_was_not_written_here(path, name):
    there = path.with_name(name)
    there.write_text('{"format": "mine"}')
    with pytest.raises(StateFileError, match=f"cannot be written: {name} is there already"):
        save_state(path, PAPER, STATE)
    assert there.read_text() == '{"format": "mine"}'


@pytest.mark.parametrize("part", [0.0, 0.02, 0.5])
def test_what_a_killed_process_left_half_written_is_replaced(path, part):
    whole = path.read_bytes()
    path.with_name("state.json.part").write_bytes(whole[: int(part * len(whole))])
    save_state(path, PAPER, replace(STATE, stamp=5))
    assert load_state(path, PAPER).stamp == 5
    assert os.listdir(path.parent) == ["state.json"]


def test_refused_files_are_all_kept(path, monkeypatch):
    monkeypatch.setattr(safe_file, "MOST_ASIDE", 3)
    path.with_name("state.json.refused").symlink_to(path.with_name("victim"))
    for number in (1, 2):
        path.write_text(f"mine {number}")
        aside = put_aside(path)
        assert aside.name == f"state.json.refused.{number}"
        assert aside.read_text() == f"mine {number}"
    path.write_text("mine 3")
    with pytest.raises(ValueError, match="3 refused files are there already"):
        put_aside(path)
    assert path.read_text() == "mine 3"
    assert not path.with_name("victim").exists()


def test_no_message_repeats_what_a_file_holds(path):
    content = json.loads(path.read_text())
    del content["checksum"]
    for key in ("harmonics", "coefficients", "speed", "loads"):
        spoilt = {**content, "state": {**content["state"], key: "SECRET"}}
        text = json.dumps(spoilt, sort_keys=True, separators=(",", ":"))
        path.write_text(json.dumps({**spoilt, "checksum": sha256(text.encode()).hexdigest()}))
        with pytest.raises(StateFileError, match="refused: no state") as refused:
            load_state(path, PAPER)
        assert "SECRET" not in str(refused.value)


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
