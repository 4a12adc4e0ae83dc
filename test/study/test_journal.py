"""The journal of a study: what it keeps, and what it refuses."""

import json

import pytest

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
    assert json.loads(path.read_text()) == STUDY


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


def test_a_second_writer_is_refused(path):
    with Journal(path, STUDY), pytest.raises(OSError, match="another process is at this study"):
        Journal(path, STUDY)
