"""The machine that a user describes, read from YAML, checked, changed and written back."""

from sfd_hbm_ros.machine.components import (
    FILM_MODELS,
    Bearing,
    Damper,
    Disk,
    FilmSettings,
    Load,
    Material,
    ShaftSegment,
    Unbalance,
)
from sfd_hbm_ros.machine.errors import MachineError
from sfd_hbm_ros.machine.files import (
    machine_from_dict,
    machine_to_dict,
    read_machine,
    write_machine,
)
from sfd_hbm_ros.machine.model import Machine
from sfd_hbm_ros.machine.parts import doubts
from sfd_hbm_ros.machine.paths import get, override, override_all, unit_of

__all__ = [
    "FILM_MODELS",
    "Bearing",
    "Damper",
    "Disk",
    "FilmSettings",
    "Load",
    "Machine",
    "MachineError",
    "Material",
    "ShaftSegment",
    "Unbalance",
    "doubts",
    "get",
    "machine_from_dict",
    "machine_to_dict",
    "override",
    "override_all",
    "read_machine",
    "unit_of",
    "write_machine",
]
