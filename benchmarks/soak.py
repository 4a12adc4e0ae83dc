"""Predictor and simulator for minutes or hours: memory, processor time, losses and delays.

The simulator plays runs through both jumps of the paper's rotor while values of the machine are
changed again and again, so that curves are computed all the time.

    . scripts/environment.sh; python3 -m benchmarks.soak --minutes 10
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.utilities import try_shutdown

from benchmarks.soak_watch import SoakWatch
from benchmarks.usage import Usage, children, growth, load, usage

ROOT = Path(__file__).parents[1]
NAMESPACE = f"/soak_{os.getpid()}"  # no other nodes are to answer
MACHINE = {
    "machine_file": ROOT / "config" / "paper_rotor.yaml",
    "unbalance.disk_2.magnitude": 5.039e-4,
}
GIVEN = {
    "predictor": {**MACHINE, "speed.min": 200.0, "speed.max": 640.0},
    "simulator": {**MACHINE, "runs": 10**6, "subscribers": 2, "orbit_noise": 3e-7},
}
LOOK = 5.0  # s between two looks at the processes
CHANGE = 7.0  # s between two changes of the machine, which share no rhythm with its runs
REPORT = 60.0  # s between two lines of progress
LAST = 3.0  # s for the last messages


class Soak:
    """The nodes and what they used.

    Attributes
    ----------
    samples : dict of str to list of Usage
        By the process: the nodes and the predictor's worker.
    """

    def __init__(self, executor: SingleThreadedExecutor, watch: SoakWatch) -> None:
        self.samples: dict[str, list[Usage]] = {}
        self._executor = executor
        self._watch = watch
        self._nodes: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, name: str) -> None:
        """Start a node."""
        command = [sys.executable, "-m", f"sfd_hbm_ros.node.{name}"]
        command += ["--ros-args", "--log-level", "error", "-r", f"__ns:={NAMESPACE}"]
        for key, value in GIVEN[name].items():
            command += ["-p", f"{key}:={value}"]
        self._nodes[name] = subprocess.Popen(command, cwd=ROOT)

    def run(self, seconds: float) -> None:
        """Watch the nodes for a time [s], and change the machine now and then."""
        begin = time.monotonic()
        due = {period: period for period in (LOOK, CHANGE, REPORT)}
        while (elapsed := time.monotonic() - begin) < seconds:
            self.spin(0.1)
            for period in due:
                if elapsed < due[period]:
                    continue
                due[period] += period
                if period == LOOK:
                    self._look(elapsed)
                elif period == CHANGE:
                    self._watch.change()
                else:
                    print(f"{elapsed / 60.0:5.0f} min: {self._progress()}", flush=True)

    def spin(self, seconds: float) -> None:
        """Take messages for a time [s]."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def stop(self, name: str) -> None:
        """End a node; it must not have ended before."""
        node = self._nodes.pop(name)
        if node.poll() is not None:
            print(f"soak.py: {name} ended with exit code {node.returncode}", file=sys.stderr)
        node.terminate()
        try:
            node.wait(timeout=10.0)
        except subprocess.TimeoutExpired:
            node.kill()
            node.wait()

    def stop_all(self) -> None:
        """End all nodes that are left."""
        for name in list(self._nodes):
            self.stop(name)

    def _look(self, elapsed: float) -> None:
        """Note what the processes use."""
        processes = {name: node.pid for name, node in self._nodes.items()}
        workers = children(processes["predictor"])
        processes |= {f"worker {pid}": pid for pid in workers}
        for name, pid in processes.items():
            sample = usage(pid, elapsed)
            if sample is not None:
                self.samples.setdefault(name, []).append(sample)

    def _progress(self) -> str:
        memory = ", ".join(
            f"{name} {one[-1].memory:.0f} MiB" for name, one in self.samples.items()
        )
        return f"{len(self._watch.took)} predictions, {memory}"


def table(soak: Soak, watch: SoakWatch) -> Iterator[str]:
    """Yield the lines of the result."""
    yield "process           memory [MiB]                     growth    processor"
    yield "               first    last    most    [MiB/h, 2nd half]    [% of a core]"
    for name, samples in soak.samples.items():
        memory = [one.memory for one in samples]
        if len(samples) > 1:
            shown = f"{memory[0]:8.1f}{memory[-1]:8.1f}{max(memory):8.1f}"
            yield f"{name:12}{shown}{growth(samples):21.1f}{100.0 * load(samples):17.1f}"
    times = 1e3 * np.array(watch.took)
    p50, p99 = np.percentile(times, [50, 99]) if times.size else (math.nan, math.nan)
    missed = watch.speeds - len(watch.took)
    yield f"speeds: {watch.speeds}, {missed} without a prediction as a newer one came first"
    most = times.max(initial=0.0)
    yield f"from a speed to its prediction: p50 {p50:.1f} ms, p99 {p99:.1f} ms, max {most:.1f} ms"
    for topic, (sent, received) in watch.reliable().items():
        yield f"{topic}: {sent} sent, {received} received, {sent - received} lost"
    yield f"heartbeat: longest pause {1e3 * watch.pause:.0f} ms"
    answer = f"answered after at most {1e3 * watch.longest_answer:.0f} ms"
    yield f"machine: {watch.changes} changes, {watch.refused} refused, {answer}"
    yield f"response curves: {watch.curves}"
    yield f"warnings: {watch.raised} raised, {watch.cleared} cleared; {watch.jumps} jumps passed"


def main() -> int:
    """Run and print; the exit code is 1 where a reliable message was lost."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="how long [min]")
    minutes = parser.parse_args().minutes
    rclpy.init()
    executor = SingleThreadedExecutor()
    watch = SoakWatch(NAMESPACE)
    executor.add_node(watch)
    soak = Soak(executor, watch)
    try:
        soak.start("predictor")
        while not watch.met():
            soak.spin(0.5)
        soak.spin(LAST)  # until the predictor has found its subscribers, too
        soak.start("simulator")
        soak.run(60.0 * minutes)
        soak.stop("simulator")
        soak.spin(LAST)
    finally:
        soak.stop_all()
        try_shutdown()
    print("\n".join(table(soak, watch)))
    return int(any(sent != received for sent, received in watch.reliable().values()))


if __name__ == "__main__":
    sys.exit(main())
