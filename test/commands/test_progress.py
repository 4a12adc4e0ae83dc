"""The lines that show progress."""

import re
import time
from pathlib import Path

from sfd_hbm_ros.cli import main
from sfd_hbm_ros.commands import progress
from sfd_hbm_ros.commands.progress import share_bar


def test_a_bar_of_what_is_done_with_the_time_left(monkeypatch):
    """Five variants were there before; the next ten take 20 s, so that 35 more take 70 s."""
    clock = iter((100.0, 120.0))
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    line = share_bar(5, 50, "variants")(10, 0.0)
    assert line == f"[{'#' * 12}{'.' * 28}] 15 of 50 variants, 0:01:10 left"


def test_off_a_terminal_a_command_tells_in_plain_lines_what_it_is_at(monkeypatch, capsys):
    """The lines go to standard error alone; what is printed is not touched."""
    monkeypatch.setattr(progress, "_SILENCE", 1e-3)
    paper = str(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")
    assert main(["sweep", paper, "--rpm", "3000:3200", "--harmonics", "1"]) == 0
    out, err = capsys.readouterr()
    assert " points in " in out
    assert "at work" not in out
    lines = err.splitlines()
    assert all(re.match(r"sweep: at work for \d+ s(, |$)", line) for line in lines)
    assert any(re.search(r", \d+ points, 3\d\d\d\.\d rpm", line) for line in lines)


def test_a_command_that_counts_nothing_tells_that_it_is_at_work(monkeypatch, capsys):
    monkeypatch.setattr(progress, "_SILENCE", 1e-3)
    with progress.at_work("solve"):
        deadline = time.monotonic() + 60.0
        err = ""
        while "at work" not in err and time.monotonic() < deadline:
            time.sleep(1e-3)
            err += capsys.readouterr().err
    assert err.startswith("solve: at work for 0 s\n")
