"""How time and memory grow: harmonics, dampers, coordinates.

. scripts/environment.sh; python3 -m benchmarks.scaling

Follows the branch of variants of the paper's rotor near 3 500 rpm at a tolerance of 1e-9, judges
every point's stability, and prints processor times relative to the first variant of each table.
The preparation (assembly, factors and modes, the first solution) is timed beside the points. Every
variant has a process of its own, whose greatest memory is that of Python, the kernels and it.
"""

import argparse
import dataclasses
import multiprocessing
import resource
import statistics
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, NewtonOptions, solve, stability
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.machine import Bearing, Damper, Disk, Machine, read_machine
from sfd_hbm_ros.units import RPM

Part = TypeVar("Part", Disk, Bearing, Damper)

PAPER = read_machine(Path(__file__).parents[1] / "config" / "paper_rotor.yaml")
START, END = 3400.0 * RPM, 3600.0 * RPM
OPTIONS = ContinuationOptions(first_step=0.02, longest_step=0.02, points=20)
RUNS = 3
HIGHEST = (1, 7, 15, 31)
ELEMENTS = (24, 249, 2499, 9999)  # 102, 1 002, 10 002 and 40 002 coordinates
DAMPERS = (1, 2, 4, 8)


def refined(elements: int) -> Machine:
    """The paper's rotor with as many elements, its own cut as evenly as may be."""
    [segment] = PAPER.shaft
    cuts = [len(part) for part in np.array_split(np.arange(elements), segment.elements)]
    nodes = np.concatenate([[0], np.cumsum(cuts)]).tolist()
    shaft = tuple(
        dataclasses.replace(segment, elements=number, length=segment.length / number)
        for number in cuts
    )

    def moved(parts: tuple[Part, ...]) -> tuple[Part, ...]:
        return tuple(dataclasses.replace(one, node=nodes[one.node]) for one in parts)

    return dataclasses.replace(
        PAPER,
        shaft=shaft,
        disks=moved(PAPER.disks),
        bearings=moved(PAPER.bearings),
        dampers=moved(PAPER.dampers),
    )


def with_dampers(number: int) -> Machine:
    """The paper's rotor with further dampers, alike, spread over the shaft from its end."""
    (damper,) = PAPER.dampers
    dampers = tuple(
        dataclasses.replace(damper, name=f"damper_{i + 1}", node=damper.node - 3 * i)
        for i in range(number)
    )
    return dataclasses.replace(PAPER, dampers=dampers)


class Cost(NamedTuple):
    """Coordinates, processor times of preparation and of a point [s], greatest memory [MB]."""

    coordinates: int
    preparation: float
    point: float
    memory: float


def measure(machine: Machine, highest: int) -> Cost:
    """Measure one variant."""
    prepare_and_follow(PAPER, 1)  # compiled code is loaded
    started = time.process_time()
    balance, x = prepare_and_follow(machine, highest)
    prepared = time.process_time() - started
    times = []
    for _ in range(RUNS):
        started = time.process_time()
        points = follow(balance, x)
        times.append((time.process_time() - started) / points)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return Cost(balance.model.size, prepared, statistics.median(times), memory)


def prepare_and_follow(machine: Machine, highest: int) -> tuple[HarmonicBalance, np.ndarray]:
    """All that is done once: the balance, with a first solution and branch."""
    balance = HarmonicBalance(machine, Harmonics(highest))
    x = solve(balance, START).coefficients.ravel()
    follow(balance, x)
    return balance, x


def follow(balance: HarmonicBalance, x: np.ndarray) -> int:
    """Follow the branch with the stability of its points; their number."""
    count = 0
    for point in Branch(
        SpeedFamily(balance), x, START, END, options=OPTIONS, newton=NewtonOptions(tolerance=1e-9)
    ):
        stability(balance, solution_at(balance, point.value, point.x))
        count += 1
    return count


def table(heading: str, variants: Iterable[tuple[int, Machine, int]]) -> list[Cost]:
    """Print the costs of variants, each a label, a machine and its highest harmonic."""
    print(f"\n| {heading} | coordinates | a point | ratio | preparation | ratio | memory |")
    print("|---|---|---|---|---|---|---|")
    costs: list[Cost] = []
    for label, machine, highest in variants:
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
            costs.append(process.submit(measure, machine, highest).result())
        size, prepared, point, memory = costs[-1]
        print(
            f"| {label} | {size} | {1e3 * point:.2f} ms | {point / costs[0].point:.2f} "
            f"| {1e3 * prepared:.0f} ms | {prepared / costs[0].preparation:.1f} "
            f"| {memory:.0f} MB |",
            flush=True,
        )
    return costs


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0]).parse_args()
    table("highest harmonic", ((k, PAPER, k) for k in HIGHEST))
    table("dampers", ((n, with_dampers(n), 7) for n in DAMPERS))
    costs = table("elements", ((n, refined(n), 7) for n in ELEMENTS))
    sizes, preparations, *_ = np.log(costs).T
    exponent = np.polyfit(sizes[1:], preparations[1:], 1)[0]
    print(
        f"\nFrom {costs[1].coordinates} coordinates on, the preparation grows with the power "
        f"{exponent:.2f} of their number."
    )


if __name__ == "__main__":
    main()
