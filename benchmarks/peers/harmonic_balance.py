"""A continuation point of the paper's rotor, beside pyHarm's."""

from collections.abc import Iterator

import numpy as np

from benchmarks.peers.environments import Peer
from benchmarks.peers.problem import NEWTON, PAPER, RPM, TOLERANCE, Row, median_seconds
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve, stability
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.solve import solution_at

PYHARM = Peer("pyharm-os", "1.2.2", "pyharm")
HIGHEST = (1, 3, 5, 7)
SAMPLES = 128
START = 3400.0 * RPM
STEP = 10.0 * RPM
POINTS = 3  # of pyHarm; ours, which are fast, are ten times as many


def rows() -> Iterator[Row]:
    """One row for each number of harmonics."""
    for k in HIGHEST:
        balance = HarmonicBalance(PAPER, Harmonics(k, SAMPLES))
        first = solve(balance, START, options=NEWTON)
        theirs = PYHARM.run(_problem(balance, first))
        worst = 0.0
        for speed, journal in zip(theirs["speeds"], theirs["journal"], strict=True):
            own = solve(balance, speed, start=first, options=NEWTON).coefficients
            worst = max(worst, float(np.abs(own - journal).max()) / PAPER.dampers[0].clearance)
        yield Row(
            f"continuation point, 102 coordinates, k = {k} (ours with stability, theirs without)",
            "pyHarm",
            seconds_a_point(balance, first),
            theirs["seconds"],
            f"{worst:.0e} of the clearance; Newton steps a point: "
            f"{theirs['iterations']:.1f} of theirs",
        )


def seconds_a_point(balance: HarmonicBalance, first: Solution) -> float:
    """Processor time of a point with its stability, about `STEP` after another."""
    x, end, points = first.coefficients.ravel(), START + 100.0 * STEP, 10 * POINTS
    tangent = next(iter(Branch(SpeedFamily(balance), x, START, end))).tangent
    step = STEP / (end - START) / tangent[-1]
    options = ContinuationOptions(first_step=step, longest_step=step, points=points)

    def follow() -> None:
        for point in Branch(SpeedFamily(balance), x, START, end, options=options, newton=NEWTON):
            stability(balance, solution_at(balance, point.value, point.x))

    return median_seconds(follow, repeats=5) / points


def _problem(balance: HarmonicBalance, first: Solution) -> dict[str, object]:
    start = balance.harmonics.coefficients(balance.response(first))
    return {
        "harmonics": balance.harmonics.highest,
        "samples": SAMPLES,
        "start": start.ravel().tolist(),
        "speed": START,
        "step": STEP,
        "points": POINTS,
        "residual": TOLERANCE * balance.at(START).load,
    }
