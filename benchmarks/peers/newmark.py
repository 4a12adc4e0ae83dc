"""Steady state and critical speeds of the paper's rotor, beside ROSS's."""

from collections.abc import Iterator

import numpy as np

from benchmarks.peers.environments import Peer
from benchmarks.peers.problem import NEWTON, PAPER, SPEED, Row, median_seconds
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.rotor import assemble, critical_speeds

ROSS = Peer("ross-rotordynamics", "3.1.0", "ross", python=13)
REVOLUTIONS, STEPS = 60, 720
MODES = 16  # that ROSS is asked for, axial and torsional ones among them


def rows() -> Iterator[Row]:
    """The steady state by Newmark's method, and the linear rotor."""
    theirs = ROSS.run(
        {"speed": SPEED, "revolutions": REVOLUTIONS, "steps": STEPS, "criticals": MODES}
    )
    balance = HarmonicBalance(PAPER, Harmonics(7, 128))
    exact = solve(balance, SPEED, options=NEWTON).eccentricity_max
    steady = theirs["steady_state"]
    *_, before, reached = steady["eccentricity"]
    yield Row(
        f"steady state at one speed from nothing (ROSS: {REVOLUTIONS} revolutions of {STEPS} "
        "steps)",
        "ROSS, Newmark",
        median_seconds(lambda: solve(balance, SPEED, options=NEWTON), repeats=5),
        steady["seconds"],
        f"eccentricity {exact:.5f} and {reached:.5f}, which changed by "
        f"{abs(reached - before):.0e} in the last revolution",
    )
    model = assemble(PAPER)
    own = np.array([one.speed for one in critical_speeds(model)])
    found = np.array([one for one in theirs["critical_speeds"] if one > 1.0])
    lowest = own[own <= found.max() * (1.0 + 1e-3)]
    nearest = found[np.abs(found[:, np.newaxis] / lowest - 1.0).argmin(axis=0)]
    worst = float(np.max(np.abs(nearest / lowest - 1.0)))
    yield Row(
        "critical speeds of the linear rotor",
        "ROSS",
        median_seconds(lambda: critical_speeds(model), repeats=5),
        theirs["critical_seconds"],
        f"{len(lowest)} speeds to {worst:.0e}",
    )
