"""SIGKILL where the machine is bistable, again and again: what is there of branch and alarm then.

A predictor is brought onto a branch, and its alarm is latched and acknowledged. Then it is killed
as it runs, as it writes its state file and as it starts, in turns. Each time it must come back on
its branch, whose eccentricity has a closed form, and with its alarm as it was.

    . scripts/environment.sh; python3 -m benchmarks.killed --times 20
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from itertools import cycle, islice
from pathlib import Path
from statistics import median

from benchmarks.usage import usage
from test.node.graph import Graph
from test.node.process import NodeProcess
from test.node.victim import BRANCHES, Victim


class Score:
    """What became of the predictors.

    Attributes
    ----------
    restored, half_written : int
        How many came back as they were, and how many were killed in the midst of writing.
    active, times, processor : list of float
        Times from a start until it is active and until the first valid prediction is here, and
        processor time until then [s].
    """

    def __init__(self) -> None:
        self.restored = self.half_written = 0
        self.active: list[float] = []
        self.times: list[float] = []
        self.processor: list[float] = []

    def run(self, victim: Victim, times: int) -> None:
        """Kill one in all ways in turns."""
        kills = cycle((victim.kill_running, victim.kill_writing, victim.kill_starting))
        for kill in islice(kills, times):
            kill()
            active, here = victim.revive()
            self.active.append(active)
            self.times.append(here)
            used = usage(victim.process.pid, self.times[-1])
            assert used is not None  # as it has just predicted
            self.processor.append(used.cpu)
            lost = victim.lost()
            self.restored += not lost
            if lost:
                print(f"killed.py: after {kill.__name__}: {lost}", file=sys.stderr)
        self.half_written += victim.half_written


def shown(times: Sequence[float]) -> str:
    """Return the spread of times [s] in words."""
    return f"min {min(times):.2f} s, median {median(times):.2f} s, max {max(times):.2f} s"


def main() -> int:
    """Kill, print the score, and return 1 where not all were restored."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--times", type=int, default=20, help="times that it is killed")
    parser.add_argument("--seed", type=int, default=1, help="of the moments")
    arguments = parser.parse_args()
    graph, score, processes = Graph(), Score(), []

    def start(*given: str) -> NodeProcess:
        processes.append(NodeProcess("predictor", "--ros-args", *given))
        return processes[-1]

    try:
        for i, branch in enumerate(BRANCHES):
            with tempfile.TemporaryDirectory() as folder:
                victim = Victim(graph, start, Path(folder), branch, arguments.seed + i)
                score.run(victim, (arguments.times + i) // len(BRANCHES))
                processes[-1].end()
    finally:
        for process in processes:
            process.end()
        graph.close()
    print(f"restored: {score.restored} of {len(score.times)}")
    print(f"killed in the midst of writing: {score.half_written}")
    print(f"from the start until it is active: {shown(score.active)}")
    print(f"from the start to the first valid prediction: {shown(score.times)}")
    print(f"processor time until then: {shown(score.processor)}")
    return int(score.restored < len(score.times))


if __name__ == "__main__":
    sys.exit(main())
