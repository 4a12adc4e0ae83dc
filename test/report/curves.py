"""Response curves that the pictures are tried on."""

from functools import cache

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, JournalMotion, Outcome, Solution
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.machine import override_all
from sfd_hbm_ros.response.curves.curve import ResponseCurve, parameter_curve, response_curve
from sfd_hbm_ros.response.curves.judged import CurveBranch

from ..hbm.machines import PAPER

RPM = np.pi / 30.0
DAMPER = "damper_1"
UNBALANCE = "unbalance.disk_2.magnitude"


@cache
def jumping():
    """Two branches, one with a fold and one that ends after a Neimark-Sacker bifurcation."""
    balance = HarmonicBalance(override_all(PAPER, {UNBALANCE: 5.039e-4}), Harmonics(1))
    nearest = ContinuationOptions(eccentricity=0.94)
    return response_curve(balance, 3900.0 * RPM, 4300.0 * RPM, nearest)


@cache
def sagging():
    """One branch with two folds near each other, off the centre."""
    balance = HarmonicBalance(override_all(PAPER, {"gravity": True}), Harmonics(2))
    return response_curve(balance, 3900.0 * RPM, 4100.0 * RPM)


@cache
def unbalanced():
    """One branch over a small unbalance."""
    balance = HarmonicBalance(PAPER, Harmonics(1))
    return parameter_curve(balance, 4050.0 * RPM, UNBALANCE, 1e-4, 1.5e-4)


def motion(coefficients, clearance=1e-4, **harmonics):
    """A motion of given coefficients [m], (rows, 2)."""
    highest = harmonics.pop("highest", len(coefficients) // 2)
    return JournalMotion(DAMPER, clearance, Harmonics(highest, **harmonics), coefficients)


def made(values, motions, instability=None, fold=None):
    """A curve of one branch through given motions at given speeds [rad/s]."""
    balance = HarmonicBalance(PAPER, motions[0].harmonics)
    solutions = tuple(
        Solution(value, one.harmonics, Outcome.CONVERGED, "", (), {DAMPER: one})
        for value, one in zip(values, motions, strict=True)
    )
    branch = CurveBranch(
        SpeedFamily(balance),
        np.array(values),
        solutions,
        instability or (None,) * len(values),
        np.zeros(len(values), bool) if fold is None else fold,
        Stop.RANGE,
    )
    return ResponseCurve(balance, SpeedFamily(balance), (branch,))
