"""How well the predictor warns of jumps: a process of its own, noisy speeds, in real time.

The runs are those of `benchmarks.warned` on which a machine jumps and the speed alone tells on
which branch it begins. Before each, the speed goes from the end of the range to where the run
starts and rests there, so that the predictor has followed the machine. Where the computer was too
busy to publish the speeds in time, the run is not judged.

    . scripts/environment.sh; python3 -m benchmarks.warned_by_node --runs 12
"""

from __future__ import annotations

import itertools
import os
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

import numpy as np
import rclpy
from rclpy.utilities import try_shutdown

from benchmarks.warned import SETTINGS, WRONG, Outcome, arguments, outcome, score
from benchmarks.warned_in_time import jump_in_time
from benchmarks.warned_machine import WarnedMachine
from benchmarks.warned_run import Run, random_run
from sfd_hbm_ros.machine import write_machine
from sfd_hbm_ros.response.curves.journey import span
from sfd_hbm_ros.response.curves.place import places_at
from sfd_hbm_ros.response.errors import NoSolutionError
from test.node.process import NodeProcess

NAMESPACE = f"/warned_{os.getpid()}"  # no other predictor is to answer
APPROACH = 8.0  # s of a run before the jump that the curve shows
LATE = 0.1  # s by which a speed may be published late: with more the machine ran otherwise


def cases(seed: int, first: int) -> Iterator[tuple[int, Run, float]]:
    """Yield number, run and the time of its jump [s], of those on which a machine jumps."""
    for number in itertools.count(first):
        try:
            case = random_run(np.random.default_rng([seed, number]), APPROACH)
            places = places_at(case.curve.branches, case.first.value)
            if np.isinf(case.fold) or sum(place.stable for place in places) > 1:
                continue
            jump = jump_in_time(case)
        except NoSolutionError:
            continue
        if np.isfinite(jump):
            yield number, case, jump


def judge(
    case: Run, jump: float, rng: np.random.Generator, wrong: float = 0.0, load: float = 0.0
) -> Outcome:
    """Run a machine before a predictor and see what became of it.

    A part `wrong` of the speeds is half or twice what it should be, and a load of mean 0 and this
    rms [N] acts at the first station.
    """
    lowest, highest = span(case.curve.branches)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "machine.yaml"
        write_machine(case.curve.balance.machine, file)
        values = {
            "machine_file": file,
            "harmonics": case.curve.balance.harmonics.highest,
            "speed.min": lowest,
            "speed.max": highest,
            **{f"alarm.{key}": value for key, value in asdict(SETTINGS).items()},
        }
        given = [part for key, value in values.items() for part in ("-p", f"{key}:={value}")]
        log = "--log-level", "error"
        predictor = NodeProcess(
            "predictor", "--ros-args", *log, "-r", f"__ns:={NAMESPACE}", *given
        )
        station = case.curve.balance.machine.disks[0].name
        machine = WarnedMachine(NAMESPACE, rng, wrong, (station, load) if load else None)
        try:
            machine.enter(case.first.value, case.ramp.start)
            changes = machine.run(case.ramp, jump)
        finally:
            machine.destroy_node()
            predictor.end()
    verdict, about = outcome(case, jump, changes)
    if machine.late > LATE:
        return Outcome("not judged: speeds were late", f"{about}, by up to {machine.late:.2f} s")
    return Outcome(verdict, about)


def main() -> int:
    """Run and print; the exit code is 1 where a run was missed or chattered."""
    given = arguments(__doc__.partition("\n")[0], runs=12)
    counts = Counter[str]()
    rclpy.init()
    try:
        for number, case, jump in itertools.islice(cases(given.seed, given.first), given.runs):
            rng = np.random.default_rng([given.seed, number])
            verdict, about = judge(case, jump, rng, given.wrong_speeds, given.load_noise)
            counts[verdict] += 1
            print(f"{number:4}  {verdict:12}  {about}", flush=True)
    finally:
        try_shutdown()
    print("\n".join(score(counts)))
    return int(any(counts[verdict] for verdict in WRONG))


if __name__ == "__main__":
    raise SystemExit(main())
