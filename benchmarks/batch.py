"""A study of many variants on all cores, beside the same variants one after the other.

Unbalance, viscosity and clearance of the paper's rotor are drawn at random; each variant is the
response curve from 3 000 to 5 000 rpm with its jumps and stability, quasi-periodic responses among
them. The time of a study holds that of starting its processes.

    . scripts/environment.sh; python3 -m benchmarks.batch --variants 1000
"""

import argparse
import os
import time

from benchmarks.scaling import PAPER
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.study.design import Design
from sfd_hbm_ros.study.distributions import Normal
from sfd_hbm_ros.study.processes import on_processes
from sfd_hbm_ros.study.task import Outcome, Task
from sfd_hbm_ros.units import RPM

SCATTER = {
    "unbalance.disk_2.magnitude": Normal(4.319e-4, 0.4e-4),
    "dampers.damper_1.viscosity": Normal(0.028, 0.002),
    "dampers.damper_1.clearance": Normal(2.54e-4, 0.1e-4),
}


def timeless(outcome: Outcome) -> tuple[object, ...]:
    """What both ways must agree on: all but the time."""
    return outcome.run_up, outcome.coast_down, outcome.peak_speed, outcome.reason


def main() -> int:
    """Measure and print; the exit code is 1 where both ways do not agree."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--variants", type=int, default=1000, help="how many variants")
    parser.add_argument("--harmonics", type=int, default=1, help="highest harmonic")
    given = parser.parse_args()
    design = Design({}, SCATTER, given.variants)
    limits = 3000.0 * RPM, 5000.0 * RPM
    k = given.harmonics
    task = Task(PAPER, design.paths, *limits, HarmonicsOptions(fewest=k, most=k))
    variants = dict(enumerate(design.values.tolist()))
    task.outcome(variants[0])  # compiled code is loaded
    begin = time.perf_counter()
    alone = {number: task.outcome(values) for number, values in variants.items()}
    middle = time.perf_counter()
    together = dict(on_processes(task, variants))
    one, all_cores = middle - begin, time.perf_counter() - middle
    print(f"{given.variants} curves one after the other: {one:.1f} s")
    cores = os.cpu_count()
    print(f"as a study on {cores} cores: {all_cores:.1f} s, {one / all_cores:.2f} times faster")
    agree = all(timeless(alone[number]) == timeless(together[number]) for number in variants)
    print("the outcomes are the same" if agree else "the outcomes differ")
    return int(not agree)


if __name__ == "__main__":
    raise SystemExit(main())
