"""BLAS threads: one within what is small, as many as before outside, whatever came first."""

import os
import subprocess
import sys
from multiprocessing import Pipe
from pathlib import Path

import pytest
import scipy.linalg  # noqa: F401 - it and NumPy load their BLAS libraries

from sfd_hbm_ros.threads import one_blas_thread

from .blas import blas_threads

ROOT = Path(__file__).parents[1]
PAPER = ROOT / "config" / "paper_rotor.yaml"
pytestmark = pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="needs /proc")

BEFORE = "import numpy, scipy.linalg"
AFTER = "import sfd_hbm_ros.response.curves.curve"

LIBRARY = f"""
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.response.curves.curve import response_curve

class Watched(HarmonicBalance):
    def at(self, speed):
        inside.append(blas_threads())
        return super().at(speed)

inside, outside = [], blas_threads()
balance = Watched(read_machine({str(PAPER)!r}), Harmonics(1))
solve(balance, 300.0)
between = blas_threads()
response_curve(balance, 300.0, 301.0)
try:
    response_curve(balance, 300.0, 301.0, progress=lambda _: 1 / 0)
except ZeroDivisionError:
    pass
print(outside, set().union(*inside), between, blas_threads())
"""

COMMAND = f"""
from sfd_hbm_ros import cli
from sfd_hbm_ros.commands import solve

def run(chosen):
    inside.append(blas_threads())
    original(chosen)
    inside.append(blas_threads())

original, solve.run = solve.run, run
inside, outside = [], blas_threads()
cli.main(["solve", {str(PAPER)!r}, "--rpm", "3000", "--harmonics", "1", "--json"])
print(outside, set().union(*inside), blas_threads(), blas_threads())
"""

NODE = """
import sfd_hbm_ros.node.predictor
from rclpy.node import Node
from sfd_hbm_ros.node.process import run

inside, outside = [], blas_threads()
run("n", lambda: Node("n"), lambda node: inside.append(blas_threads()) or node.destroy_node())
print(outside, *inside, blas_threads(), blas_threads())
"""

WORKER = """
from sfd_hbm_ros.node.worker import process

inside, outside = [], blas_threads()
process.serve = lambda connection: inside.append(blas_threads())
process.load_kernels = lambda: None
process.main()
print(outside, *inside, blas_threads(), blas_threads())
"""


@pytest.mark.parametrize("first", [BEFORE, AFTER], ids=["NumPy first", "this package first"])
@pytest.mark.parametrize("script", [LIBRARY, COMMAND], ids=["library", "command line"])
def test_one_thread_within_and_the_former_ones_outside(first, script):
    assert printed_by(script, first) == "{2} {1} {2} {2}"


def test_one_thread_in_a_node():
    pytest.importorskip("rclpy")
    assert printed_by(NODE, BEFORE) == "{2} {1} {2} {2}"


def test_one_thread_in_the_worker_of_a_node():
    ours, theirs = Pipe()
    with ours, theirs:
        assert printed_by(WORKER, BEFORE, theirs.fileno()) == "{2} {1} {2} {2}"


def printed_by(script: str, first: str, *descriptors: int) -> str:
    """The last line that a process prints which begins with two BLAS threads."""
    code = f"{first}\nfrom test.blas import blas_threads\n{script}"
    told = subprocess.run(
        [sys.executable, "-c", code, *map(str, descriptors)],
        pass_fds=descriptors,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        cwd=ROOT,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "2"},
    )
    return told.stdout.splitlines()[-1]


def test_entries_within_one_another_and_errors_are_left_in_order():
    before = blas_threads()

    @one_blas_thread
    def failing():
        with one_blas_thread:
            assert blas_threads() == {1}
        assert blas_threads() == {1}
        raise KeyError

    with pytest.raises(KeyError):
        failing()
    assert blas_threads() == before
