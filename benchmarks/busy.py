"""Commands as a user types them, alone and beside busy processes.

    . scripts/environment.sh; python3 -m benchmarks.busy [--processes 2] [--times 3]

No environment variable limits the threads of BLAS; the package does that itself.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAPER = str(ROOT / "config" / "paper_rotor.yaml")
SWEEP = ["sweep", PAPER, "--rpm", "2000:6000"]
COMMANDS = {
    "sweep": SWEEP,
    "sweep with gravity": [*SWEEP, "--set", "gravity=true"],
    "paper": ["paper"],
}
LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@contextmanager
def busy(processes: int) -> Iterator[None]:
    """Have so many processes do nothing else than keep a core busy."""
    started = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)
    ]
    try:
        yield
    finally:
        for process in started:
            process.kill()
            process.wait()


def seconds(command: list[str]) -> float:
    """Return how long a command takes [s]."""
    environment = {name: value for name, value in os.environ.items() if name not in LIMITS}
    begun = time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "sfd_hbm_ros", *command],
        env=environment,
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return time.perf_counter() - begun


def main() -> None:
    """Print the shortest of some times of each command, alone and beside busy processes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--times", type=int, default=3)
    chosen = parser.parse_args()
    print(f"load before: {os.getloadavg()[0]:.1f}")
    print(f"{'':20} alone [s]  beside {chosen.processes} busy processes [s]")
    for name, command in COMMANDS.items():
        alone = min(seconds(command) for _ in range(chosen.times))
        with busy(chosen.processes):
            beside = min(seconds(command) for _ in range(chosen.times))
        print(f"{name:20} {alone:9.2f}  {beside:9.2f}", flush=True)


if __name__ == "__main__":
    main()
