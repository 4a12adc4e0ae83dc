"""Harmonic balance: the periodic response of a machine on its squeeze films."""

from sfd_hbm_ros.hbm.balance import Equations, HarmonicBalance
from sfd_hbm_ros.hbm.floquet import Instability, Stability, stability
from sfd_hbm_ros.hbm.harmonics import Harmonics
from sfd_hbm_ros.hbm.newton import Outcome
from sfd_hbm_ros.hbm.options import NewtonOptions
from sfd_hbm_ros.hbm.solution import JournalMotion, Solution
from sfd_hbm_ros.hbm.solve import solve, solve_equations

__all__ = [
    "Equations",
    "HarmonicBalance",
    "Harmonics",
    "Instability",
    "JournalMotion",
    "NewtonOptions",
    "Outcome",
    "Solution",
    "Stability",
    "solve",
    "solve_equations",
    "stability",
]
