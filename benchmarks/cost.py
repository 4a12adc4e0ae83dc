"""Where the time of one continuation point goes.

. scripts/environment.sh; python3 -m benchmarks.cost [--machine FILE] [--harmonics K]

The branch of the machine is followed from 2 000 to 6 000 rpm at a tolerance of 1e-9, its stability
judged at every point, with a clock at each stage. A stage's time is its own, without that of the
stages it calls; all times are the process's own, so that other programs disturb them little.
"""

import argparse
import functools
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from sfd_hbm_ros.film import ShortFilm
from sfd_hbm_ros.hbm import (
    Equations,
    HarmonicBalance,
    Harmonics,
    NewtonOptions,
    corrector,
    floquet,
    solve,
)
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.rotor import Condensation
from sfd_hbm_ros.units import RPM

PAPER = Path(__file__).parents[1] / "config" / "paper_rotor.yaml"
RUNS = 5
STAGES: tuple[tuple[str, Any, str], ...] = (
    ("film", ShortFilm, "linearise"),
    ("condensation", Condensation, "at"),
    ("linear part of the equations", HarmonicBalance, "at"),
    ("transforms and Jacobian", Equations, "linearise"),
    ("transforms and Jacobian, slope by the speed", Equations, "slope_by_speed"),
    ("eccentricity", Equations, "eccentricity"),
    ("linear solves", corrector, "_solved"),
    ("stability", floquet, "stability"),
)


class Stopwatch:
    """Own time and number of calls of each stage."""

    def __init__(self) -> None:
        self.nanoseconds: Counter[str] = Counter()
        self.calls: Counter[str] = Counter()
        self._nested = [0]  # time of the calls within each call that is under way

    def __call__(self, label: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function with a clock."""

        @functools.wraps(function)
        def timed(*args: Any, **kwargs: Any) -> Any:
            self._nested.append(0)
            started = time.process_time_ns()
            try:
                return function(*args, **kwargs)
            finally:
                elapsed = time.process_time_ns() - started
                self.nanoseconds[label] += elapsed - self._nested.pop()
                self.calls[label] += 1
                self._nested[-1] += elapsed

        return timed


def follow(balance: HarmonicBalance, judge: bool) -> int:
    """Follow the branch and return the number of its points."""
    start, end = 2000.0 * RPM, 6000.0 * RPM
    first = solve(balance, start).coefficients.ravel()
    options = NewtonOptions(tolerance=1e-9)
    count = 0
    for point in Branch(SpeedFamily(balance), first, start, end, newton=options):
        count += 1
        if judge:
            floquet.stability(balance, solution_at(balance, point.value, point.x))
    return count


def seconds_a_point(balance: HarmonicBalance, judge: bool) -> float:
    """Time of a point, the least of several runs."""
    times = []
    for _ in range(RUNS):
        started = time.process_time()
        points = follow(balance, judge)
        times.append((time.process_time() - started) / points)
    return min(times)


def staged(balance: HarmonicBalance) -> tuple[Stopwatch, int]:
    """The stages' times in the fastest of several runs, and its number of points.

    What no stage accounts for is under the label "" of the stopwatch.
    """
    kept = [(owner, name, getattr(owner, name)) for _, owner, name in STAGES]
    runs = []
    for _ in range(RUNS):
        watch = Stopwatch()
        for (label, owner, name), (_, _, function) in zip(STAGES, kept, strict=True):
            setattr(owner, name, watch(label, function))
        try:
            runs.append((watch, watch("", follow)(balance, judge=True)))
        finally:
            for owner, name, function in kept:
                setattr(owner, name, function)
    return min(runs, key=lambda run: run[0].nanoseconds.total())


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--machine", type=Path, default=PAPER)
    parser.add_argument("--harmonics", type=int, default=7)
    arguments = parser.parse_args()
    balance = HarmonicBalance(read_machine(arguments.machine), Harmonics(arguments.harmonics))
    follow(balance, judge=True)
    alone, judged = seconds_a_point(balance, False), seconds_a_point(balance, True)
    watch, points = staged(balance)
    print("| stage | calls a point | us a call | us a point |\n|---|---|---|---|")
    for label, _, _ in STAGES:
        microseconds, calls = 1e-3 * watch.nanoseconds[label], max(watch.calls[label], 1)
        print(
            f"| {label} | {calls / points:.2f} | {microseconds / calls:.1f}"
            f" | {microseconds / points:.0f} |"
        )
    rest = 1e-3 * watch.nanoseconds[""] / points
    print(f"| the rest, Python and the clocks | | | {rest:.0f} |")
    print(f"| **a point with its stability** | | | **{1e6 * judged:.0f}** |")
    print(f"| a point without | | | {1e6 * alone:.0f} |")


if __name__ == "__main__":
    main()
