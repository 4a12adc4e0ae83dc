"""How the time of a continuation point grows: harmonics, coordinates, dampers.

. scripts/environment.sh; python3 -m benchmarks.scaling [--longest N]

Follows the branch of variants of the paper's rotor near 3 500 rpm at a tolerance of 1e-9, judges
every point's stability, and prints processor times relative to the first variant of each table.
The preparation (assembly, factors and modes, the first solution) is timed beside the points.
"""

import argparse
import dataclasses
import statistics
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, NewtonOptions, solve, stability
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.machine import Machine, read_machine
from sfd_hbm_ros.units import RPM

PAPER = read_machine(Path(__file__).parents[1] / "config" / "paper_rotor.yaml")
START, END = 3400.0 * RPM, 3600.0 * RPM
OPTIONS = ContinuationOptions(first_step=0.02, longest_step=0.02, points=20)
RUNS = 3
HIGHEST = (1, 7, 15, 31)
FINENESS = (1, 10, 30, 100)  # elements in place of each of the paper's 24
DAMPERS = (1, 2, 4, 8)


def refined(factor: int) -> Machine:
    """The paper's rotor with each shaft element cut into several."""
    shaft = tuple(
        dataclasses.replace(one, elements=factor * one.elements, length=one.length / factor)
        for one in PAPER.shaft
    )
    return dataclasses.replace(
        PAPER,
        shaft=shaft,
        disks=tuple(dataclasses.replace(one, node=factor * one.node) for one in PAPER.disks),
        bearings=tuple(dataclasses.replace(one, node=factor * one.node) for one in PAPER.bearings),
        dampers=tuple(dataclasses.replace(one, node=factor * one.node) for one in PAPER.dampers),
    )


def with_dampers(number: int) -> Machine:
    """The paper's rotor with further dampers, alike, spread over the shaft from its end."""
    (damper,) = PAPER.dampers
    dampers = tuple(
        dataclasses.replace(damper, name=f"damper_{i + 1}", node=damper.node - 3 * i)
        for i in range(number)
    )
    return dataclasses.replace(PAPER, dampers=dampers)


def measure(machine: Machine, highest: int) -> tuple[int, float, float]:
    """Number of coordinates, processor times of the preparation and of a point [s]."""
    started = time.process_time()
    balance = HarmonicBalance(machine, Harmonics(highest))
    first = solve(balance, START)
    follow(balance, first.coefficients.ravel())
    prepared = time.process_time() - started
    times = []
    for _ in range(RUNS):
        started = time.process_time()
        points = follow(balance, first.coefficients.ravel())
        times.append((time.process_time() - started) / points)
    return balance.model.size, prepared, statistics.median(times)


def follow(balance: HarmonicBalance, x: np.ndarray) -> int:
    """Follow the branch with the stability of its points; their number."""
    count = 0
    for point in Branch(
        SpeedFamily(balance), x, START, END, options=OPTIONS, newton=NewtonOptions(tolerance=1e-9)
    ):
        stability(balance, solution_at(balance, point.value, point.x))
        count += 1
    return count


def table(heading: str, variants: Iterable[tuple[int, Machine, int]]) -> None:
    """Print the times of variants, each a label, a machine and its highest harmonic."""
    print(f"\n| {heading} | coordinates | a point | ratio | preparation | ratio |")
    print("|---|---|---|---|---|---|")
    base: tuple[float, float] | None = None
    for label, machine, highest in variants:
        try:
            size, prepared, point = measure(machine, highest)
        except MemoryError:
            print(f"| {label} | | not enough memory | | | |", flush=True)
            continue
        base = base or (prepared, point)
        print(
            f"| {label} | {size} | {1e3 * point:.2f} ms | {point / base[1]:.2f} "
            f"| {1e3 * prepared:.0f} ms | {prepared / base[0]:.1f} |",
            flush=True,
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument(
        "--longest", type=int, default=10, help="elements in place of one, 100 for 10 002 (slow)"
    )
    longest = parser.parse_args().longest
    measure(PAPER, 1)  # compiled code is loaded
    table("highest harmonic", ((k, PAPER, k) for k in HIGHEST))
    table("dampers", ((n, with_dampers(n), 7) for n in DAMPERS))
    table("elements for one", ((n, refined(n), 7) for n in FINENESS if n <= longest))


if __name__ == "__main__":
    main()
