"""Processes that die at their work."""

import os
from dataclasses import dataclass

import pytest

from sfd_hbm_ros.study.complete import complete
from sfd_hbm_ros.study.design import Design
from sfd_hbm_ros.study.errors import IncompleteError
from sfd_hbm_ros.study.journal import Journal
from sfd_hbm_ros.study.processes import on_processes
from sfd_hbm_ros.study.task import Outcome

from ..blas import blas_threads


@dataclass(frozen=True)
class Deadly:
    """A task at which some variants kill the process that computes them."""

    deadly: tuple[float, ...]

    def outcome(self, values):
        if values[0] in self.deadly:
            os._exit(1)
        return Outcome(None, None, None, values[0], 0.5, 0.0, str(blas_threads()))


def test_only_what_kills_its_process_is_left_out(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")  # what a process begins with
    variants = {number: (float(number),) for number in range(10)}
    found = dict(on_processes(Deadly((4.0,)), variants, processes=2))
    assert sorted(found) == [0, 1, 2, 3, 5, 6, 7, 8, 9]
    assert all(outcome.peak_speed == number for number, outcome in found.items())
    assert {outcome.reason for outcome in found.values()} == {"{1}"}  # one BLAS thread each


def test_a_study_says_what_it_lacks_and_keeps_the_rest(tmp_path):
    design = Design({"a": (1.0, 2.0, 3.0)}, {})
    shown = []

    def compute(variants):
        return on_processes(Deadly((2.0,)), variants, processes=1)

    with Journal(tmp_path / "journal", {}) as journal:
        sentence = r"^1 of 3 variants were not computed, as the processes at them died; the same"
        with pytest.raises(IncompleteError, match=sentence):
            complete(journal, design, compute, shown.append)
    assert sorted(shown) == [0, 2]
    with Journal(tmp_path / "journal", {}) as journal:
        assert sorted(journal.outcomes) == [0, 2]
