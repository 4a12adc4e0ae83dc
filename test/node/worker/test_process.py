"""The worker process beside its node: what it loads, and that it does not outlive the node."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import pytest

from ..process import ROOT
from .test_worker import LIMIT, state

pytestmark = pytest.mark.skipif(not os.path.exists("/proc/self/maps"), reason="needs /proc")

#: Stands for a node: a main module with side effects, which must not happen in the worker.
NODE = """
import time
from sfd_hbm_ros.node.worker.worker import Worker
from test.node.worker.test_worker import SLOW

try:
    import rclpy
except ImportError:
    pass

worker = Worker()
results = 0
while True:
    if worker.job is None:
        worker.request(SLOW)
    results += worker.poll() is not None
    if worker.points >= 2:
        print(worker.pid, results, flush=True)
    time.sleep(0.01)
"""


@pytest.fixture
def node(tmp_path) -> Iterator[subprocess.Popen[str]]:
    script = tmp_path / "node.py"
    script.write_text(NODE)
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        [sys.executable, str(script)],
        stdout=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        env=environment,
    ) as process:
        yield process
        process.kill()


def worker_of(node: subprocess.Popen[str], results: int = 0) -> int:
    """The process that is at work for a node after so many results."""
    assert node.stdout is not None
    for line in node.stdout:
        pid, so_far = map(int, line.split())
        if so_far >= results:
            return pid
    return pytest.fail("the node has ended")


def test_the_worker_gives_way_and_loads_no_ros(node):
    pid = worker_of(node)
    nice = os.getpriority(os.PRIO_PROCESS, pid) - os.getpriority(os.PRIO_PROCESS, node.pid)
    assert nice == min(10, 19 - os.getpriority(os.PRIO_PROCESS, node.pid))
    with open(f"/proc/{pid}/maps") as file:
        loaded = file.read()
    assert "numpy" in loaded
    assert "rclpy" not in loaded


def test_ctrl_c_is_for_the_node_alone(node):
    pid = worker_of(node)
    assert os.getpgid(pid) != os.getpgid(node.pid)
    os.kill(pid, signal.SIGINT)
    assert worker_of(node, results=1) == pid


@pytest.mark.parametrize("stopped", [False, True])
def test_the_worker_does_not_outlive_a_killed_node(node, stopped):
    pid = worker_of(node)
    if stopped:
        os.kill(pid, signal.SIGSTOP)
        until(lambda: state(pid) == "T")
    node.kill()
    node.wait()
    until(lambda: state(pid) in ("", "Z"))


def until(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + LIMIT
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)
