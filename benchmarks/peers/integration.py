"""The whole response curve, beside our own time integration of 200 speeds."""

import statistics
import time
from collections.abc import Iterator

import numpy as np

from benchmarks.peers.problem import PAPER, RPM, Row, median_seconds
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.response.curves.curve import response_curve
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import run

LOWEST, HIGHEST, SPEEDS = 2000.0 * RPM, 6000.0 * RPM, 200
INTEGRATED = np.array([2500.0, 3300.0, 3900.0, 4500.0, 5500.0]) * RPM
SETTLED = 1e-4  # change of the eccentricity over a stretch at which a motion counts as steady
STRETCH = 10  # revolutions
STRETCHES = 100


def rows() -> Iterator[Row]:
    """The one row."""
    balance = HarmonicBalance(PAPER, Harmonics(7, 128))
    integrator = Integrator(balance, HIGHEST)
    settle(integrator, INTEGRATED[0])
    times, errors = [], []
    for speed in INTEGRATED.tolist():
        started = time.process_time()
        reached = settle(integrator, speed)
        times.append(time.process_time() - started)
        errors.append(abs(reached - solve(balance, speed).eccentricity_max))
    yield Row(
        f"response curve from 2 000 to 6 000 rpm (integration: {SPEEDS} speeds, extrapolated "
        f"from {INTEGRATED.size})",
        "our time integration",
        median_seconds(lambda: response_curve(balance, LOWEST, HIGHEST), repeats=3),
        SPEEDS * statistics.mean(times),
        f"eccentricities to {max(errors):.0e}",
    )


def settle(integrator: Integrator, speed: float) -> float:
    """Integrate from the response at the speed before until steady; the eccentricity reached."""
    before = speed - (HIGHEST - LOWEST) / SPEEDS
    state, last = integrator.start(solve(integrator.balance, before)), np.inf
    for _ in range(STRETCHES):
        transient = run(integrator, Ramp(speed, 0.0, STRETCH), state)
        state, reached = transient.state, float(transient.worst_eccentricity[-1])
        if abs(reached - last) <= SETTLED:
            return reached
        last = reached
    raise ArithmeticError(f"not steady after {STRETCHES * STRETCH} revolutions")
