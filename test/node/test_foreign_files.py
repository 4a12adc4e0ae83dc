"""What others on the network, and links, can make the node do to its user's files."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from .graph import Graph, Remote  # first, as it skips the file without ROS

# isort: split
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter

from .bistable import BOTH, UPPER_ONLY, given
from .process import PAPER_ROTOR, NodeProcess

OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"
SECRET = "root:$6$Zb5tq8hd$secret:19000:0:99999:7:::\nbin:*:19000:0:99999:7:::\n"

Start = Callable[..., NodeProcess]


class Attacked:
    """A predictor that waits unconfigured, whose machine files lie in a folder; and a victim's.

    Parameters
    ----------
    folder : Path
        Where all of it goes.
    *arguments : str
        Of the predictor.
    """

    def __init__(self, graph: Graph, start: Start, folder: Path, *arguments: str) -> None:
        self.machines = folder / "machines"
        self.machines.mkdir()
        self.machine = self.machines / "machine.yaml"
        self.machine.write_text(PAPER_ROTOR.read_text())
        self.victim = folder / "victim"
        self.victim.write_text(SECRET)
        self.folder = folder
        name = folder.name
        autostart = "-p", "autostart:=false", "-r", f"__node:={name}"
        self.process = start("-p", f"machine_file:={self.machine}", *autostart, *arguments)
        self.remote = Remote(graph, f"/{name}")
        self.remote.until_status("Model", OK, "unconfigured")
        self._before = self._files()

    def refuses(self, name: str, value: object, reason: str) -> None:
        """Check that a parameter cannot be set by either service, for a reason."""
        result = self.remote.set({name: str(value)})
        assert not result.successful
        assert reason in result.reason
        request = SetParameters.Request()
        request.parameters = [Parameter(name, value=str(value)).to_parameter_msg()]
        service = f"{self.remote.name}/set_parameters"
        [result] = self.remote.graph.call(SetParameters, service, request).results
        assert not result.successful
        assert reason in result.reason

    def check(self) -> None:
        """Check that the node works, has touched no file and told nothing of their content."""
        assert self.remote.change_state("configure", "activate", "deactivate") == [True] * 3
        assert self.remote.change_state("cleanup") == [True]
        assert self._files() == self._before
        self.tells_nothing()

    def tells_nothing(self) -> None:
        """Check that nobody hears what a secret file holds."""
        assert self.process.running
        statuses = str(self.remote.statuses.values())
        for word in ("$6$", "bin:", "19000", "secret:"):
            assert word not in statuses
            assert word not in self.process.said()

    def _files(self) -> dict[str, bytes]:
        return {
            str(path): path.read_bytes()
            for path in sorted(self.folder.rglob("*"))
            if path.is_file() and not path.is_symlink()
        }


@pytest.fixture(scope="module")
def attacked(graph: Graph, start: Start, tmp_path_factory) -> Attacked:
    return Attacked(graph, start, tmp_path_factory.mktemp("attacked"))


@pytest.fixture(scope="module")
def confined(graph: Graph, start: Start, tmp_path_factory) -> Attacked:
    folder = tmp_path_factory.mktemp("confined")
    return Attacked(graph, start, folder, "-p", f"machine_folder:={folder / 'machines'}")


def test_no_peer_names_a_state_file(attacked):
    reason = "state_file is fixed: it is read when the node starts"
    for path in (attacked.victim, "/", "state.json", "/etc/passwd", "~/.bashrc"):
        attacked.refuses("state_file", path, reason)
    attacked.refuses("state_file", "x" * 5000, "state_file must be text of at most 1000")
    attacked.refuses("machine_folder", "/", "machine_folder is fixed")
    attacked.check()


def test_no_peer_names_a_machine_file(attacked):
    for path in (attacked.victim, "/etc/shadow", attacked.machines / "other.yaml", "/dev/zero"):
        attacked.refuses("machine_file", path, "machine_file is fixed, as no machine_folder")
    assert attacked.remote.set({"machine_file": str(attacked.machine)}).successful
    attacked.check()


def test_peers_name_machine_files_below_the_folder_alone(confined):
    machines, remote = confined.machines, confined.remote
    (machines / "link.yaml").symlink_to(confined.victim)
    for path in (
        confined.victim,
        machines / "link.yaml",
        machines / ".." / "victim",
        machines,
        f"{machines}2/machine.yaml",
    ):
        confined.refuses("machine_file", path, "must be a file below machine_folder")
    inside = machines / "below" / "inside.yaml"
    inside.parent.mkdir()
    inside.write_text(confined.machine.read_text())
    assert remote.set({"machine_file": str(inside)}).successful
    assert remote.change_state("configure") == [True]
    result = remote.set({"machine_file": str(confined.machine)})
    assert "machine_file can only be changed while the node is unconfigured" in result.reason
    assert remote.set({"machine_file": str(inside)}).successful  # as it is already
    assert remote.change_state("cleanup") == [True]
    # A link that comes after the check is found when the file is read.
    inside.unlink()
    inside.symlink_to(confined.victim)
    assert remote.change_state("configure") == [False]
    remote.until_status("Model", ERROR, "must be a file below machine_folder")
    confined.tells_nothing()


CONTENTS = {
    SECRET: "is no machine file",
    "%hidden words": "is not YAML",
    "*hidden": "aliases are not allowed",
    "hidden words": "the machine must be a mapping with the keys",
    "- hidden words": "the machine must be a mapping with the keys",
    "hidden: words": "is no machine file: it has none of the keys name, materials",
    "hidden: 1\nhidden: words": "line 2, column 1: a key stands twice",
    "nmae: hidden words\nshaft: []": "nmae is unknown (did you mean name?)",
    "materials: hidden words": "materials must be a mapping of 1 or more names",
    "materials: {steel: hidden words}": "materials.steel must be a mapping",
    PAPER_ROTOR.read_text().replace("0.0762", "hidden"): "diameter must be a finite number [m]",
    PAPER_ROTOR.read_text().replace("steel}", "hidden}"): "must be one of the materials",
}


def test_nothing_of_a_file_is_told_but_the_key_at_fault(confined):
    remote = confined.remote
    for number, (content, reason) in enumerate(CONTENTS.items()):
        file = confined.machines / f"file_{number}.yaml"
        file.write_text(content)
        assert remote.set({"machine_file": str(file)}).successful
        assert remote.change_state("configure") == [False], content
        told = remote.until_status("Model", ERROR, f"{file}: ")
        assert reason in told.message
        assert "hidden" not in str(told)
    assert "hidden" not in confined.process.said()
    confined.tells_nothing()


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir])
def test_a_machine_file_that_is_none_does_not_hang_it(confined, make):
    path = confined.machines / f"{make.__name__}.yaml"
    make(path)
    remote = confined.remote
    assert remote.set({"machine_file": str(path)}).successful
    assert remote.change_state("configure") == [False]
    remote.until_status("Model", ERROR, f"{path}: cannot be read: not a regular file")
    remote.beats()


@pytest.mark.parametrize("path", ["/", "/dev/null", "none/such/state.json"])
def test_a_state_file_that_cannot_be_is_survived_by_all_transitions(graph, start, tmp_path, path):
    name = f"survivor_{abs(hash(path))}"
    process = start(*given(tmp_path, f"state_file:={path}"), "-r", f"__node:={name}")
    remote = Remote(graph, f"/{name}")
    remote.meet(UPPER_ONLY)
    remote.predict(UPPER_ONLY)
    remote.until_status("Model", WARN, "state file", lambda: remote.send(BOTH, remote.now()))
    remote.restart()
    remote.meet(UPPER_ONLY)
    assert remote.state() == "active"
    assert process.stop(15) == 0, process.said()
    assert "Traceback" not in process.said()


def test_links_and_files_beside_the_state_file_are_left_alone(graph, start, tmp_path):
    victim, file = tmp_path / "victim", tmp_path / "state.json"
    victim.write_text("mine")
    file.write_text("mine, and no state file")
    part, aside = (tmp_path / f"state.json.{end}" for end in ("part", "refused"))
    part.symlink_to(victim)
    aside.symlink_to(victim)
    start(*given(tmp_path, f"state_file:={file}"), "-r", "__node:=linked")
    remote = Remote(graph, "/linked")
    remote.meet(UPPER_ONLY)
    where = f"{file}: cannot be written: a link, which is not followed"
    remote.until_status("Model", WARN, where, lambda: remote.send(UPPER_ONLY, remote.now()))
    assert victim.read_text() == "mine"
    assert part.is_symlink()
    assert aside.is_symlink()
    assert (tmp_path / "state.json.refused.1").read_text() == "mine, and no state file"
    part.unlink()
    remote.graph.until(file.exists, "it is saved", lambda: remote.send(UPPER_ONLY, remote.now()))
    assert victim.read_text() == "mine"
