"""The journal of a study: what it keeps, and what it refuses."""

import json
import os
from dataclasses import asdict

import pytest

from sfd_hbm_ros.study.errors import StudyError
from sfd_hbm_ros.study.journal import Journal
from sfd_hbm_ros.study.task import Outcome

STUDY = {"machine": {"name": "rotor"}, "rpm": [1.0, 2.0], "seed": 0}
JUMP = Outcome(0.1 + 0.2, 1.0 / 3.0, 1e-300, 412.7, 0.9, 0.5, "")
NONE = Outcome(None, None, None, None, None, 0.1, "no solution at 3 rpm: \u201cwhy\u201d\n")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "study.csv.journal"


def test_outcomes_come_back_exactly(path):
    with Journal(path, STUDY) as journal:
        journal.add(7, JUMP)
        journal.add(2, NONE)
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {7: JUMP, 2: NONE}


def test_an_outcome_is_on_the_disk_at_once(path):
    with Journal(path, STUDY) as journal:
        journal.add(7, JUMP)
        assert len(path.read_text().splitlines()) == 2


@pytest.mark.parametrize("lost", [1, 5, 40])
def test_a_line_that_was_cut_off_is_written_anew(path, lost):
    with Journal(path, STUDY) as journal:
        journal.add(7, JUMP)
        journal.add(2, NONE)
    path.write_bytes(path.read_bytes()[:-lost])
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {7: JUMP}
        journal.add(2, NONE)
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {7: JUMP, 2: NONE}


def test_a_first_line_that_was_cut_off_is_written_anew(path):
    Journal(path, STUDY).__exit__()
    path.write_bytes(path.read_bytes()[:10])
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {}
    assert json.loads(path.read_text()).items() >= STUDY.items()


def test_another_study_is_refused_with_what_differs(path):
    Journal(path, STUDY).__exit__()
    with pytest.raises(ValueError, match="holds a study with another rpm, seed; delete it"):
        Journal(path, STUDY | {"rpm": [1.0, 3.0], "seed": 1})


@pytest.mark.parametrize("text", ["speed_rpm,stable\n1,2\n", "no line", "[1]\n", '{}\n{"a": 1}\n'])
def test_what_is_no_journal_is_refused_and_left_alone(path, text):
    path.write_text(text)
    with pytest.raises(ValueError, match=r"is not the journal of a study|holds a study"):
        Journal(path, STUDY)
    assert path.read_text() == text


@pytest.mark.parametrize("place", [0.3, 0.5, 0.7, 0.9])
def test_a_damaged_line_is_computed_again(path, place):
    with Journal(path, STUDY) as journal:
        for number in range(4):
            journal.add(number, JUMP)
    first, *lines = path.read_bytes().splitlines(keepends=True)
    digit = int(place * len(lines[1]))
    lines[1] = lines[1][:digit] + bytes([lines[1][digit] ^ 1]) + lines[1][digit + 1 :]
    path.write_bytes(first + b"".join(lines))
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {0: JUMP, 2: JUMP, 3: JUMP}
        assert journal.damaged == 1
        journal.add(1, NONE)
    with Journal(path, STUDY) as journal:
        assert journal.outcomes == {0: JUMP, 1: NONE, 2: JUMP, 3: JUMP}


FOREIGN = [
    {"variant": "7"},
    {"variant": -1},
    {"variant": True},
    {"variant": None},
    {"run_up": "fast"},
    {"run_up": [1.0]},
    {"reason": None},
    {"seconds": None},
    {"colour": 1},
]


@pytest.mark.parametrize("change", FOREIGN, ids=str)
def test_lines_of_a_wrong_type_count_as_damaged(path, change):
    with Journal(path, STUDY) as journal:
        journal._write({"variant": 7, **asdict(JUMP), **change})  # with the right checksum
    with Journal(path, STUDY) as journal:
        assert (journal.outcomes, journal.damaged) == ({}, 1)


def test_lines_of_any_depth_count_as_damaged(path):
    Journal(path, STUDY).__exit__()
    with path.open("ab") as file:
        file.write(b"[" * 1_000_000 + b"\n" + b'{"a":' * 1_000_000 + b"\n[]\n7\nnull\n\xff\n\n")
    with Journal(path, STUDY) as journal:
        assert (journal.outcomes, journal.damaged) == ({}, 7)


def test_a_first_line_of_any_depth_is_no_journal(path):
    path.write_bytes(b"[" * 1_000_000 + b"\n")
    with pytest.raises(StudyError, match="is not the journal of a study"):
        Journal(path, STUDY)


def test_a_pipe_is_no_journal(path):
    os.mkfifo(path)
    with pytest.raises(StudyError, match="is not a regular file"):
        Journal(path, STUDY)


def test_a_second_writer_is_refused(path):
    with Journal(path, STUDY), pytest.raises(OSError, match="another process is at this study"):
        Journal(path, STUDY)
