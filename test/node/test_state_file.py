"""A state file that is of no use or cannot be written: told, survived and overcome by the node."""

import os
import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from .graph import Graph, Remote  # first, as it skips the file without ROS

# isort: split
from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.response.tracking.state import State
from sfd_hbm_ros.response.tracking.state_file import StateFileError, load_state, save_state

from .bistable import BOTH, MACHINE, UPPER_ONLY, given, orbits
from .process import NodeProcess

OK, WARN = b"\x00", b"\x01"
LOWER, UPPER = 0, 1
NAME = "remembering"


class Remembering:
    """A predictor and its state file, in which it remembers that it is on the upper branch."""

    def __init__(self, graph: Graph, start: Callable[..., NodeProcess], folder: Path) -> None:
        self.file = folder / "states" / "state.json"
        self.aside = self.file.with_name("state.json.refused")
        self.file.parent.mkdir()
        arguments = given(folder, f"state_file:={self.file}")
        self.process = start(*arguments, "-r", f"__node:={NAME}")
        self.remote = Remote(graph, f"/{NAME}")
        self.remote.meet(UPPER_ONLY)
        self.remote.until_warning(OK, "down to", UPPER_ONLY)
        self.remote.predict(BOTH)
        self._upper = self.until_saved(lambda state: state.settled and state.speed == BOTH)

    def begin(self) -> None:
        """Have it go on from the upper branch, all being well."""
        self.forget()
        save_state(self.file, MACHINE, self._upper)
        self.recall()
        self.says(OK, "active")
        self.predicts(UPPER)

    def forget(self) -> None:
        """Have it give up its machine, and remove what it has left."""
        self.remote.change_state("deactivate", "cleanup")
        for path in (self.file, self.aside):
            path.unlink(missing_ok=True)

    def recall(self) -> None:
        """Have it begin with what is in the file."""
        assert self.remote.change_state("configure", "activate") == [True, True]

    def predicts(self, branch: int) -> None:
        """Check on which branch it predicts where there are two."""
        eccentricity, _ = self.remote.predict(BOTH)
        assert eccentricity["damper_1/max"] == pytest.approx(orbits(BOTH)[branch], abs=1e-8)

    def says(self, level: bytes, part: str) -> None:
        """Wait until it says something about its model while it predicts."""
        self.remote.until_status("Model", level, part, self._send)

    def saved(self) -> State | None:
        """Return what is in the file, or nothing where that is of no use."""
        try:
            return load_state(self.file, MACHINE)
        except StateFileError:
            return None

    def until_saved(self, wanted: Callable[[State], bool]) -> State:
        """Wait until a state is saved that is as wanted."""

        def found() -> State | None:
            state = self.saved()
            return state if state and wanted(state) else None

        state: State = self.remote.graph.until(found, "a state is saved", self._send)
        return state

    def _send(self) -> None:
        self.remote.send(BOTH, self.remote.now())


@pytest.fixture(scope="module")
def running(graph: Graph, start, tmp_path_factory) -> Remembering:
    return Remembering(graph, start, tmp_path_factory.mktemp("machine"))


@pytest.fixture
def predictor(running: Remembering) -> Remembering:
    running.begin()
    return running


def foreign(path: Path) -> None:
    """Write the state of another machine."""
    state = State(400.0, Harmonics(1), np.zeros((3, 2)), True, 0, {})
    save_state(path, replace(MACHINE, name="another"), state)


def impossible(path: Path) -> None:
    """Write what older versions believed of a speed that the machine cannot have."""
    save_state(path, MACHINE, State(1e6, Harmonics(1), np.full((3, 2), 1e-14), True, 0, {}))


def torn(part: float):
    """Leave a part of a file."""
    return lambda path: os.truncate(path, int(part * path.stat().st_size))


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (torn(0.0), "torn, it is not whole JSON text"),
        (torn(0.1), "torn, it is not whole JSON text"),
        (torn(0.5), "torn, it is not whole JSON text"),
        (torn(0.99), "torn, it is not whole JSON text"),
        (
            lambda path: path.write_text(path.read_text().replace("1", "2", 1)),
            "of a version",
        ),
        (lambda path: path.write_bytes(b"\xff" + os.urandom(5000)), "not UTF-8 text"),
        (foreign, "foreign, the state of another machine"),
        (impossible, "a speed must be below"),
    ],
    ids=["empty", "begun", "half", "almost whole", "newer", "random", "foreign", "impossible"],
)
def test_a_file_of_no_use_is_reported_and_put_aside(predictor, spoil, reason):
    assert predictor.remote.change_state("deactivate", "cleanup") == [True, True]
    spoil(predictor.file)
    spoilt = predictor.file.read_bytes()
    predictor.recall()
    predictor.says(WARN, f"{predictor.file}: refused: {reason}")
    assert f"state file {predictor.file}: refused: {reason}" in predictor.process.said()
    predictor.predicts(LOWER)  # as it knows no better
    assert predictor.aside.read_bytes() == spoilt
    predictor.until_saved(lambda state: state.speed == BOTH)


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (os.mkdir, "not a regular file"),
        (os.mkfifo, "not a regular file"),
        (partial(os.symlink, "/dev/full"), "a link, which is not followed"),
    ],
)
def test_what_is_no_file_is_reported_and_left_alone(predictor, make, what):
    predictor.forget()
    file = predictor.file
    make(file)
    before = os.lstat(file)
    predictor.recall()
    predictor.says(WARN, f"{file}: refused: {what}; nothing is written while it is there")
    predictor.predicts(LOWER)
    assert os.path.samestat(os.lstat(file), before)
    os.rmdir(file) if file.is_dir() else os.unlink(file)
    predictor.until_saved(lambda state: state.speed == BOTH)


def test_a_folder_that_is_away_for_a_while(predictor):
    """Nothing can be written below a file, whatever the rights of who tries."""
    folder, away = predictor.file.parent, predictor.file.parent.with_name("away")
    folder.rename(away)
    folder.touch()
    predictor.says(WARN, f"{predictor.file}: cannot be written: Not a directory")
    predictor.predicts(UPPER)
    folder.unlink()
    away.rename(folder)
    older = predictor.saved()
    assert older
    predictor.says(OK, "active")
    predictor.until_saved(lambda state: state.stamp > older.stamp)


def test_on_a_full_disk_the_older_state_is_kept(predictor):
    with no_room(predictor.process.pid):
        predictor.says(WARN, f"{predictor.file}: cannot be written: File too large")
        older = predictor.file.read_bytes()
        predictor.remote.beats()
        predictor.predicts(UPPER)
        assert predictor.remote.set({"frame_id": "shaft"}).successful
        predictor.remote.restart()
        predictor.predicts(UPPER)  # from the older state
        predictor.says(WARN, "File too large")
        assert predictor.file.read_bytes() == older
        assert os.listdir(predictor.file.parent) == [predictor.file.name]
    predictor.says(OK, "active")
    predictor.predicts(UPPER)
    assert predictor.file.read_bytes() != older


@contextmanager
def no_room(pid: int) -> Iterator[None]:
    """Have every file that a process writes be too large, its logs included."""
    limits = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, limits[1]))
    try:
        yield
    finally:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, limits)
