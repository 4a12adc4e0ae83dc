"""Time from a speed to its prediction, through DDS, between two processes.

Starts the predictor and publishes stamped speeds that run up and down between 200 and 600 rad/s:
first when the response curve is there and nothing else is to be done, and then while curves are
computed, since a value of the machine is changed every other second. A speed is lost where a newer
one came before it was the predictor's turn. Printed are the times until the predictions with these
stamps had arrived, the processor time that the predictor took, the time from a change of the
machine to its curve, and the predictor's memory at the end. The first row tells how far the
computer itself is late: by how much a sleep of a period overruns, with nothing else to be done.

    . scripts/environment.sh; python3 -m benchmarks.latency --rate 50 200 --seconds 20
"""

from __future__ import annotations

import argparse
import itertools
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.utilities import try_shutdown

from benchmarks.latency_stopwatch import Stopwatch
from benchmarks.usage import Usage, usage

ROOT = Path(__file__).parents[1]
NAMESPACE = f"/latency_{os.getpid()}"  # no other predictor is to answer
PAUSE = 2.0  # s between two changes of the machine
CURVES = 3  # of which the time is taken
CHANGED = "dampers.damper_1.viscosity"
VALUES = itertools.cycle((0.0294, 0.028))  # Pa s: 5 % more, and that of the file


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    add = parser.add_argument
    add("--rate", type=float, nargs="+", default=[50.0, 200.0], help="speeds a second [Hz]")
    add("--seconds", type=float, default=20.0, help="how long to publish each time [s]")
    add("--harmonics", type=int, default=7, help="highest harmonic")
    given = parser.parse_args()
    predictor = _start(given.harmonics)
    try:
        rclpy.init()
        stopwatch = Stopwatch(NAMESPACE)
        stopwatch.meet()
        for line in _lines(stopwatch, predictor.pid, given.rate, given.seconds):
            print(line, flush=True)
    except TimeoutError as error:
        sys.exit(f"latency.py: {error}")
    finally:
        predictor.terminate()
        predictor.wait()
        try_shutdown()


def _start(harmonics: int) -> subprocess.Popen[bytes]:
    """Start the predictor."""
    values = {
        "machine_file": ROOT / "config" / "paper_rotor.yaml",
        "harmonics": harmonics,
        "publish_rate": 1000.0,
    }
    command = [sys.executable, "-m", "sfd_hbm_ros.node.predictor", "--ros-args"]
    command += ["--log-level", "warn", "-r", f"__ns:={NAMESPACE}"]
    for name, value in values.items():
        command += ["-p", f"{name}:={value}"]
    return subprocess.Popen(command, cwd=ROOT)


def _lines(stopwatch: Stopwatch, pid: int, rates: list[float], seconds: float) -> Iterator[str]:
    """Measure, and yield the lines of the table as they come."""
    yield "speeds                    p50     p99     max [ms]   lost        processor [%]"
    yield _row("the computer itself", _overruns(1.0 / max(rates), seconds))
    for rate in rates:
        for name, between in (("idle", _nothing), ("computing", _changing(stopwatch))):
            stopwatch.settle()
            before = _used(pid)
            times = stopwatch.run(rate, seconds, between)
            yield _row(f"{rate:3.0f} Hz, {name}", times) + _load(before, _used(pid))
    waits = []
    for _ in range(CURVES):
        stopwatch.settle()
        waits.append(stopwatch.renewed_after(CHANGED, next(VALUES)))
    shown = ", ".join(f"{wait:.2f}" for wait in waits)
    yield f"from a change of the machine to its response curve: {shown} s"
    yield f"memory: {_used(pid).memory:.0f} MiB"


def _overruns(period: float, seconds: float) -> NDArray[np.float64]:
    """By how much sleeps of a period [s] take longer."""
    overruns = []
    for _ in range(round(seconds / period)):
        start = time.perf_counter()
        time.sleep(period)
        overruns.append(time.perf_counter() - start - period)
    return np.array(overruns)


def _row(name: str, times: NDArray[np.float64]) -> str:
    arrived = 1e3 * times[np.isfinite(times)]
    lost = f"{len(times) - len(arrived)} of {len(times)}"
    numbers = [*np.percentile(arrived, [50, 99]), arrived.max()] if arrived.size else [np.nan] * 3
    columns = "".join(f"{number:8.1f}" for number in numbers)
    return f"{name:20}{columns}     {lost:>13}"


def _load(before: Usage, after: Usage) -> str:
    load = 100.0 * (after.cpu - before.cpu) / (after.time - before.time)
    return f"{load:13.1f}"


def _nothing() -> None:
    """Leave the predictor alone."""


def _changing(stopwatch: Stopwatch) -> Callable[[], None]:
    """Change the machine now and then, so that its worker computes."""
    due = 0.0

    def change() -> None:
        nonlocal due
        if time.monotonic() >= due:
            due = time.monotonic() + PAUSE
            stopwatch.change(CHANGED, next(VALUES))

    return change


def _used(pid: int) -> Usage:
    used = usage(pid, time.monotonic())
    if used is None:
        raise TimeoutError("the predictor has ended")
    return used


if __name__ == "__main__":
    main()
