"""What the command line writes is looked at before anything is computed."""

import os
import shutil
from pathlib import Path

import pytest

from sfd_hbm_ros.cli import main

from .studies import CURVE, GRID, PAPER

SIMULATE = ("simulate", "--from", "3000", "--to", "3010", "--rate", "100")
SWEEP = ("sweep", "--rpm", "3000:3010")
STUDY = ("study", *CURVE, *GRID)
ENDLESS = ("--set", "dampers.damper_1.viscosity=nonsense")
"""What would be refused next: where its sentence does not come, nothing was read or computed."""


@pytest.fixture
def machine(tmp_path):
    """A machine file of which a user would be sorry to lose it."""
    path = tmp_path / "rotor.csv"
    shutil.copy(PAPER, path)
    return path


def refused(verb, machine, *options):
    """The sentence with which a verb refuses its options, and nothing else."""
    name, *rest = verb
    return main([name, str(machine), *rest, *ENDLESS, *map(str, options)])


@pytest.mark.parametrize("verb", [SIMULATE, SWEEP, STUDY])
@pytest.mark.parametrize(
    ("option", "name", "sentence"),
    [
        ("--output", "table.xlsx", "the name of a table must end in .csv"),
        ("--output", "table", "the name of a table must end in .csv"),
        ("--output", "table.csv.gz", "the name of a table must end in .csv"),
        ("--picture", "picture.bmp", "the name of a picture must end in one of ."),
        ("--picture", "picture", "the name of a picture must end in one of ."),
        ("--output", "no/such/folder/table.csv", "no file can be made in the folder "),
        ("--picture", "no/such/folder/picture.png", "no file can be made in the folder "),
        ("--output", "/proc/table.csv", "no file can be made in the folder /proc: "),
    ],
)
def test_what_cannot_be_written_is_refused_first(
    verb, option, name, sentence, machine, tmp_path, capsys
):
    needed = ("--output", tmp_path / "x.csv") if verb is STUDY and option != "--output" else ()
    path = tmp_path / name
    assert refused(verb, machine, *needed, option, path) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"sfd_hbm: {option} {path}: {sentence}")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == [machine]


@pytest.mark.parametrize("verb", [SIMULATE, SWEEP, STUDY])
@pytest.mark.parametrize("kind", ["itself", "link", "hard link", "way round"])
def test_the_machine_file_is_not_written_over(verb, kind, machine, tmp_path, capsys):
    output = {"itself": machine, "way round": tmp_path / ".." / tmp_path.name / machine.name}
    path = output.get(kind, tmp_path / "other.csv")
    if kind == "link":
        path.symlink_to(machine)
    if kind == "hard link":
        os.link(machine, path)
    assert refused(verb, machine, "--output", path) == 2
    _, err = capsys.readouterr()
    assert err == (
        f"sfd_hbm: --output {path}: would overwrite the machine file; give another name\n"
    )
    assert machine.read_bytes() == Path(PAPER).read_bytes()


def test_nor_by_a_journal_or_a_picture(machine, tmp_path, capsys):
    journal = machine.with_name("x.csv.journal")
    os.link(machine, journal)
    assert refused(STUDY, machine, "--output", tmp_path / "x.csv") == 2
    assert f"{journal}, the study's journal: would overwrite" in capsys.readouterr().err
    picture = machine.with_name("x.png")
    picture.symlink_to(machine)
    assert refused(SWEEP, machine, "--picture", picture) == 2
    assert "would overwrite the machine file" in capsys.readouterr().err
    assert machine.read_bytes() == Path(PAPER).read_bytes()


def test_a_pipe_is_no_table(machine, tmp_path, capsys):
    """Who opens it for writing would wait for its reader."""
    os.mkfifo(tmp_path / "pipe.csv")
    assert refused(SWEEP, machine, "--output", tmp_path / "pipe.csv") == 2
    assert "cannot be written: not a regular file" in capsys.readouterr().err


def test_what_is_written_again_is_whole_until_then(machine, tmp_path, capsys):
    """A refusal of something else leaves an older table as it was."""
    table = tmp_path / "table.csv"
    table.write_text("older")
    assert refused(SWEEP, machine, "--output", table) == 2
    assert "viscosity must be a finite number" in capsys.readouterr().err
    assert table.read_text() == "older"


def test_figures_of_the_paper_need_a_folder(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main(["paper", "--figures", str(tmp_path / "file" / "below")]) == 2
    _, err = capsys.readouterr()
    assert err.startswith(f"sfd_hbm: --figures {tmp_path}/file/below: no file can be made in the ")


def test_a_run_of_days_is_refused(machine, capsys):
    endless = ("simulate", "--from", "3000", "--to", "4000", "--rate", "1e-6")
    assert refused(endless, machine) == 2
    _, err = capsys.readouterr()
    assert err.startswith("sfd_hbm: --rate 1e-06: must be faster, as the run would take 5.8e+10 ")
