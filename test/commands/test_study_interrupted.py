"""The verb `study` killed, interrupted and robbed of a worker: nothing is lost."""

import os
import signal

import pytest

from .studies import (
    VARIANTS,
    ended,
    kill,
    rows,
    started,
    timeless,
    wait_for_end,
    wait_for_outcomes,
    workers,
)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The table of the study without any disturbance."""
    output = tmp_path_factory.mktemp("undisturbed") / "study.csv"
    assert ended(started(output)) == (0, "")
    table = timeless(rows(output))
    assert len(table) == VARIANTS
    return table


def test_killed_and_resumed(undisturbed, tmp_path):
    output = tmp_path / "study.csv"
    killed = started(output)
    wait_for_outcomes(output, 3, killed)
    children = workers(killed)
    assert children
    kill(killed.pid)
    killed.communicate()
    wait_for_end(children)  # nobody is left behind
    assert not output.exists()
    journal = tmp_path / "study.csv.journal"
    kept = journal.read_bytes()
    journal.write_bytes(kept + b'{"variant": 11, "run_')  # a kill in the middle of a line
    assert ended(started(output)) == (0, "")
    assert timeless(rows(output)) == undisturbed
    assert journal.read_bytes().startswith(kept)
    assert journal.read_bytes().count(b"\n") == 1 + VARIANTS  # none was computed twice


def test_interrupted_in_a_terminal(tmp_path):
    """Ctrl-C goes to all processes of the group, in the midst of ten times as many variants."""
    output = tmp_path / "study.csv"
    interrupted = started(output, "--vary", "dampers.damper_1.viscosity=0.027:0.029:10")
    wait_for_outcomes(output, 2, interrupted)
    children = workers(interrupted)
    os.killpg(interrupted.pid, signal.SIGINT)
    status, err = ended(interrupted)
    assert status == 130
    assert err.startswith("sfd_hbm: interrupted: ")
    assert err.endswith(
        f" of {10 * VARIANTS} variants are in {output}.journal; the same command goes on\n"
    )
    assert err.count("\n") == 1
    wait_for_end(children)


def test_worker_is_killed(undisturbed, tmp_path):
    output = tmp_path / "study.csv"
    study = started(output)
    wait_for_outcomes(output, 2, study)
    kill(workers(study)[0])
    assert ended(study) == (0, "")
    assert timeless(rows(output)) == undisturbed
