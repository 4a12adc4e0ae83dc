"""The rotor: finite elements, condensation to the dampers' journals, whirl modes."""

from sfd_hbm_ros.rotor.assembly import GRAVITY, assemble
from sfd_hbm_ros.rotor.condensation import Condensation
from sfd_hbm_ros.rotor.condensed import Condensed
from sfd_hbm_ros.rotor.criticals import CriticalSpeed, critical_speeds
from sfd_hbm_ros.rotor.directions import Direction
from sfd_hbm_ros.rotor.errors import ResonanceError
from sfd_hbm_ros.rotor.frames import is_axisymmetric
from sfd_hbm_ros.rotor.model import RotorModel
from sfd_hbm_ros.rotor.modes import WhirlMode, campbell, whirl_modes
from sfd_hbm_ros.rotor.reduction import hold_journals, reduce_model

__all__ = [
    "GRAVITY",
    "Condensation",
    "Condensed",
    "CriticalSpeed",
    "Direction",
    "ResonanceError",
    "RotorModel",
    "WhirlMode",
    "assemble",
    "campbell",
    "critical_speeds",
    "hold_journals",
    "is_axisymmetric",
    "reduce_model",
    "whirl_modes",
]
