"""Studies that the tests run, and what comes of them."""

import csv
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAPER = str(ROOT / "config" / "paper_rotor.yaml")
UNBALANCE, SPRING = "unbalance.disk_2.magnitude", "dampers.damper_1.centering_stiffness"
CURVE = ("--rpm", "3900:4020", "--harmonics", "1", "--no-detached")
GRID = ("--vary", f"{UNBALANCE}=4e-4:4.8e-4:12", "--vary", f"{SPRING}=2.6e6:2.7e6:6")
VARIANTS = 72


def started(output, *options):
    """A study of the grid in a process of its own, its group led by it as in a terminal."""
    command = [sys.executable, "-m", "sfd_hbm_ros", "study", PAPER, *CURVE, *GRID]
    return subprocess.Popen(
        [*command, "--output", str(output), *options],
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def ended(study):
    """The exit status of a started study, and what it has to say but for its progress."""
    _, err = study.communicate(timeout=120)
    return study.returncode, without_progress(err)


def without_progress(err):
    """What was said on standard error without the lines that tell that a command is at work."""
    lines = err.splitlines(keepends=True)
    return "".join(line for line in lines if not re.match(r"\w+: at work for \d+ s", line))


def wait_for_outcomes(output, number, study):
    """Wait until the journal holds that many outcomes, fewer than all."""
    journal = Path(f"{output}.journal")
    deadline = time.monotonic() + 60.0
    while not journal.exists() or journal.read_bytes().count(b"\n") < 1 + number:
        assert study.poll() is None, study.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.01)
    assert journal.read_bytes().count(b"\n") < 1 + VARIANTS


def workers(study):
    """Process ids of the workers that a study has on this machine."""
    children = Path(f"/proc/{study.pid}/task/{study.pid}/children").read_text().split()
    command = {pid: Path(f"/proc/{pid}/cmdline").read_bytes() for pid in children}
    return [int(pid) for pid in children if b"spawn_main" in command[pid]]


def wait_for_end(pids):
    """Wait until none of the processes is there any more."""
    deadline = time.monotonic() + 20.0
    while any(Path(f"/proc/{pid}").exists() and running(pid) for pid in pids):
        assert time.monotonic() < deadline
        time.sleep(0.01)


def running(pid):
    """Whether a process is more than an entry in the table of processes."""
    try:
        return "\nState:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False


def kill(pid):
    os.kill(pid, signal.SIGKILL)


def rows(output):
    with open(output, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def timeless(table):
    """Rows of a table without the time that each took."""
    return [{key: value for key, value in row.items() if key != "seconds"} for row in table]
