"""Time from a speed to its prediction, through DDS, between two processes.

Starts the predictor, publishes stamped speeds that run up and down between 200 and 600 rad/s,
and prints what it took until the predictions with these stamps had arrived. A speed is lost where
a newer one came before it was the predictor's turn.

    . scripts/environment.sh; python3 -m benchmarks.latency --rate 50 --seconds 20
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.time import Time
from sensor_msgs.msg import JointState

from sfd_hbm_ros.node.messages.common import read_stamp, speed_message

ROOT = Path(__file__).parents[1]
NAMESPACE = f"/latency_{os.getpid()}"  # no other predictor is to answer
SECOND = 10**9
PERIOD = 10.0  # s of one run up and down
PATIENCE = 30.0  # s until the predictor must have answered


class Stopwatch:
    """Publishes speeds and notes when each left and when its prediction arrived."""

    def __init__(self) -> None:
        self._node = rclpy.create_node("latency", namespace=NAMESPACE)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._speed = self._node.create_publisher(JointState, "predictor/speed", 1)
        topic = "predictor/eccentricity"
        self._node.create_subscription(JointState, topic, self._arrive, 100)
        self._left: dict[int, float] = {}
        self._took: dict[int, float] = {}

    def meet(self) -> None:
        """Publish speeds until predictions arrive, and then forget them."""
        end = time.monotonic() + PATIENCE
        while not self._took:
            if time.monotonic() > end:
                sys.exit(f"latency.py: no prediction within {PATIENCE:g} s")
            self._send()
            self._spin(0.1)
        self._spin(1.0)
        self._left.clear()
        self._took.clear()

    def run(self, rate: float, seconds: float) -> np.ndarray:
        """Publish speeds at a rate [Hz] and return the times [s], infinite for what was lost."""
        start = time.perf_counter()
        for i in range(round(rate * seconds)):
            self._spin(start + i / rate - time.perf_counter())
            self._send()
        self._spin(2.0)
        return np.array([self._took.get(stamp, math.inf) for stamp in self._left])

    def _send(self) -> None:
        now = self._node.get_clock().now().nanoseconds
        phase = now / SECOND / PERIOD % 1.0
        speed = 200.0 + 800.0 * min(phase, 1.0 - phase)
        message = speed_message(Time(nanoseconds=now), speed, 0.0)
        self._left[now] = time.perf_counter()
        self._speed.publish(message)

    def _arrive(self, message: JointState) -> None:
        stamp = read_stamp(message.header)
        if stamp in self._left:
            self._took[stamp] = time.perf_counter() - self._left[stamp]

    def _spin(self, seconds: float) -> None:
        end = time.perf_counter() + seconds
        while (left := end - time.perf_counter()) > 0.0:
            self._executor.spin_once(timeout_sec=left)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rate", type=float, default=50.0, help="speeds a second [Hz]")
    parser.add_argument("--seconds", type=float, default=20.0, help="how long to publish [s]")
    parser.add_argument("--harmonics", type=int, default=7, help="highest harmonic")
    arguments = parser.parse_args()

    given = {
        "machine_file": ROOT / "config" / "paper_rotor.yaml",
        "harmonics": arguments.harmonics,
        "publish_rate": 1000.0,
    }
    command = [sys.executable, "-m", "sfd_hbm_ros.node.predictor"]
    command += ["--ros-args", "-r", f"__ns:={NAMESPACE}"]
    for name, value in given.items():
        command += ["-p", f"{name}:={value}"]
    predictor = subprocess.Popen(command, cwd=ROOT)
    try:
        rclpy.init()
        stopwatch = Stopwatch()
        stopwatch.meet()
        times = stopwatch.run(arguments.rate, arguments.seconds) * 1e3
    finally:
        predictor.terminate()
        predictor.wait()
        rclpy.try_shutdown()
    arrived = times[np.isfinite(times)]
    p50, p99 = np.percentile(arrived, [50, 99])
    print(
        f"{len(times)} speeds at {arguments.rate:g} Hz: p50 {p50:.1f} ms, p99 {p99:.1f} ms, "
        f"max {arrived.max():.1f} ms, {len(times) - len(arrived)} lost"
    )


if __name__ == "__main__":
    main()
