"""The curves of the paper, computed once each, on all cores."""

import multiprocessing
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import replace

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.kernels import warn_if_uncompiled
from sfd_hbm_ros.report.paper.cases import Case, Cases
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.units import RPM

_SPEEDS = 2  # at which detached branches are looked for, besides those that suggest themselves


def compute(cases: Cases, names: Iterable[str]) -> Iterator[tuple[str, ResponseCurve]]:
    """Compute curves, a process a core, and yield each with its name as it is ready.

    Raises
    ------
    NoSolutionError
        If no solution was found at an end of a curve's range.
    """
    warn_if_uncompiled()
    # not forked: other threads may hold locks
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(os.cpu_count(), context) as pool:
        tasks = {pool.submit(_compute, cases.curves[name]): name for name in names}
        try:
            for task in as_completed(tasks):
                yield tasks[task], task.result()
        finally:  # where one has failed the others are of no use
            pool.shutdown(wait=False, cancel_futures=True)


def _compute(case: Case) -> ResponseCurve:
    balance = HarmonicBalance(case.machine, Harmonics(case.harmonics))
    options = ContinuationOptions(eccentricity=case.closest)
    lowest, highest = case.speeds_rpm
    curve = response_curve(balance, lowest * RPM, highest * RPM, options)
    if case.detached_rpm is None:
        return curve
    lowest, highest = case.detached_rpm
    found = detached_branches(curve, lowest * RPM, highest * RPM, _SPEEDS, options)
    return replace(curve, detached=tuple(found))
