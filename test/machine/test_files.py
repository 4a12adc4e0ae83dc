"""Files that no machine can be read from: each sentence begins with the path and says why."""

import cProfile
import os
import re
from pathlib import Path

import pytest

from sfd_hbm_ros.machine import (
    Machine,
    MachineError,
    machine_from_dict,
    machine_to_dict,
    read_machine,
    write_machine,
)
from sfd_hbm_ros.machine.document import MAX_BYTES, parse


def refusal(path: Path) -> str:
    """Return the sentence, after its path, with which a file is refused."""
    with pytest.raises(MachineError) as error:
        read_machine(path)
    sentence = str(error.value)
    assert sentence.startswith(f"{path}: ")
    assert "\n" not in sentence
    return sentence.removeprefix(f"{path}: ")


BAD_TEXTS = [
    ("", "is empty"),
    ("# nothing but a comment\n", "is empty"),
    ("---\n", "is empty"),
    ("- 1\n", "the machine must be a mapping with the keys name, materials, shaft"),
    ("name: [1, 2\n", "line 2, column 1: while parsing a flow sequence, expected ',' or ']'"),
    (
        "shaft:\n\t- elements: 1\n",
        "line 2, column 1: while scanning for the next token, found character '\\t'",
    ),
    ("name: a: b\n", "line 1, column 8: mapping values are not allowed here"),
    ("name: a\n b: c\n", "line 2, column 3: mapping values are not allowed here"),
    ("name: a\x00b\n", "line 1: special characters are not allowed"),
    ('name: "\\U00110000"\n', "is not YAML: "),
    ('name: "\\UFFFFFFFF"\n', "is not YAML: "),
    (
        "name: a\n---\nname: b\n",
        "line 2, column 1: expected a single document in the stream, but found",
    ),
    ("name: a\nname: b\n", "line 2, column 1: the key name stands twice"),
    ("loads: [{station: a, force: 1, station: b}]\n", "line 1, column 32: the key station stands"),
    ("{[a, b]: 1}\n", "line 1, column 2: a key must be text"),
    ("a: &x [1]\nb: *x\n", "line 2, column 4: aliases are not allowed: write the values out"),
    ("a: &x {b: 1}\n<<: *x\n", "line 2, column 5: aliases are not allowed"),
    ("a: !!python/object/apply:os.getcwd []\n", "a is unknown; known here: name, materials"),
]


@pytest.mark.parametrize(("text", "sentence"), BAD_TEXTS)
def test_bad_texts_are_refused(tmp_path: Path, text: str, sentence: str) -> None:
    path = tmp_path / "machine.yaml"
    path.write_text(text, encoding="utf-8")
    assert refusal(path).startswith(sentence)


def test_a_tag_makes_no_object() -> None:
    assert parse("a: !!python/object/apply:os.getcwd []") == {"a": []}
    assert parse("a: !!python/name:os.getcwd ''") == {"a": ""}


def test_billion_laughs_are_refused_at_the_first_alias(tmp_path: Path) -> None:
    levels = [f"l{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 9)}]" for i in range(1, 10)]
    path = tmp_path / "machine.yaml"
    path.write_text("\n".join(["l0: &l0 [lol]", *levels]), encoding="utf-8")
    assert refusal(path).startswith("line 2, column 10: aliases are not allowed")


def test_a_large_file_is_refused_before_it_is_parsed(tmp_path: Path) -> None:
    # A parser would find fault with the first byte, so the sentence shows that none has run.
    path = tmp_path / "machine.yaml"
    path.write_bytes(b"]" * 10_000_000)
    assert refusal(path) == "is larger than the 256 KiB allowed"
    path.write_bytes(b"]" * (MAX_BYTES + 1))
    assert refusal(path) == "is larger than the 256 KiB allowed"


def test_a_file_beyond_all_memory_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "machine.yaml"
    path.touch()
    os.truncate(path, 2**40)  # a hole: it takes no place on the disk
    assert refusal(path) == "is larger than the 256 KiB allowed"


@pytest.mark.parametrize("text", ["[" + "a," * 130_000, "a: 1\n" * 50_000, "- {}\n" * 50_000])
def test_more_than_a_machine_needs_is_refused_early(tmp_path: Path, text: str) -> None:
    path = tmp_path / "machine.yaml"
    path.write_text(text, encoding="utf-8")
    assert re.fullmatch(
        r"line \d+, column \d+: more than 25000 keys and values are not allowed", refusal(path)
    )


@pytest.mark.parametrize("materials", [1, 1900])
def test_as_many_segments_as_anybody_needs_are_read(
    tmp_path: Path, paper_file: Path, materials: int
) -> None:
    """The time goes with their number: each takes as many calls as in a file with a tenth."""
    counts = []
    for number in (190, 1900):
        data = machine_to_dict(read_machine(paper_file))
        [steel] = data["materials"].values()
        names = [f"steel_{i}" for i in range(max(1, number * materials // 1900))]
        data["materials"] = dict.fromkeys(names, steel)
        [segment] = data["shaft"]
        data["shaft"] = [
            {**segment, "elements": 1, "material": names[i % len(names)]} for i in range(number)
        ]
        profile = cProfile.Profile()
        assert len(profile.runcall(machine_from_dict, data).shaft) == number
        counts.append(sum(entry.callcount for entry in profile.getstats()))
    assert counts[1] < 11 * counts[0]


def test_what_is_no_regular_file_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert refusal(tmp_path / "pipe") == "cannot be read: not a regular file"
    assert refusal(Path("/dev/zero")) == "cannot be read: not a regular file"
    (tmp_path / "link").symlink_to("/dev/tty")
    assert refusal(tmp_path / "link").startswith("cannot be read: ")


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "? "])
def test_deep_nesting_is_refused_at_its_thirteenth_level(tmp_path: Path, opening: str) -> None:
    path = tmp_path / "machine.yaml"
    path.write_text(opening * (MAX_BYTES // len(opening)), encoding="utf-8")
    column = 12 * len(opening) + 1
    assert refusal(path) == f"line 1, column {column}: more than 12 levels are not allowed"


def test_as_many_levels_as_allowed_are_read() -> None:
    assert parse("[" * 12 + "]" * 12) == [[[[[[[[[[[[]]]]]]]]]]]]


def test_unreadable_files_are_refused(tmp_path: Path) -> None:
    not_utf8 = tmp_path / "latin.yaml"
    not_utf8.write_bytes("name: Läufer\n".encode("latin-1"))
    assert refusal(not_utf8) == "must be UTF-8, which it is not at byte 7"
    assert refusal(tmp_path / "missing.yaml") == "cannot be read: No such file or directory"
    assert refusal(tmp_path) == "cannot be read: not a regular file"
    os.mkfifo(tmp_path / "pipe")
    assert refusal(tmp_path / "pipe") == "cannot be read: not a regular file"
    assert refusal(Path("/dev/zero")) == "cannot be read: not a regular file"
    assert refusal(not_utf8 / "inside.yaml") == "cannot be read: Not a directory"
    assert refusal(Path("a\0b")) == "cannot be read: embedded null byte"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_a_file_without_permission_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "machine.yaml"
    path.write_text("name: a\n", encoding="utf-8")
    path.chmod(0)
    assert refusal(path) == "cannot be read: Permission denied"


def test_a_bad_value_is_shown_as_it_stands_in_the_file(tmp_path: Path, paper_file: Path) -> None:
    path = tmp_path / "machine.yaml"
    text = paper_file.read_text(encoding="utf-8")
    path.write_text(text.replace("clearance: 2.54e-4", "clearance: -2.540e-04"), encoding="utf-8")
    assert refusal(path) == (
        "dampers.damper_1.clearance must be a finite number [m] above 0, not -2.540e-04"
    )


def test_a_byte_order_mark_and_windows_line_ends_are_fine(
    tmp_path: Path, paper_file: Path, paper: Machine
) -> None:
    path = tmp_path / "machine.yaml"
    content = paper_file.read_bytes()
    path.write_bytes(b"\xef\xbb\xbf" + content.replace(b"\n", b"\r\n"))
    assert read_machine(path) == paper


def test_what_cannot_be_written_is_refused(tmp_path: Path, paper: Machine) -> None:
    with pytest.raises(MachineError) as error:
        write_machine(paper, tmp_path)
    assert str(error.value) == f"{tmp_path}: cannot be written: Is a directory"
