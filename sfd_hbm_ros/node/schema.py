"""The predictor's parameters, declared once: name, default, meaning, unit and range."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

from sfd_hbm_ros.machine import Damper, Machine, Unbalance
from sfd_hbm_ros.machine.errors import show
from sfd_hbm_ros.machine.rules import Rule
from sfd_hbm_ros.response.warning.settings import AlarmSettings

Value = bool | int | float | str

LONGEST_TEXT = 1000
"""Characters that a text may have; a path or a frame is shorter."""

_WORDS = {
    bool: "true or false",
    int: "an integer",
    float: "a number",
    str: f"text of at most {LONGEST_TEXT} characters",
}


class ParameterError(ValueError):
    """A parameter that cannot be, in one sentence."""


@dataclass(frozen=True)
class Spec:
    """What a parameter means and may be.

    Parameters
    ----------
    name : str
        Its name.
    default : bool, int, float or str
        Its value unless given; its type is the parameter's.
    about : str
        What it is, for people.
    unit : str
        Its unit, if it has one.
    least, most : float
        Range of a number, both or neither.
    read_only : bool
        Whether it can only be given at the start.
    """

    name: str
    default: Value
    about: str
    unit: str = ""
    least: float = -math.inf
    most: float = math.inf
    read_only: bool = False

    @property
    def allowed(self) -> str:
        """What it may be, in words."""
        words = _WORDS[type(self.default)]
        limits = f" from {self.least:g} to {self.most:g}" if self._limited else ""
        return words + limits + (f" [{self.unit}]" if self.unit else "")

    @property
    def descriptor(self) -> ParameterDescriptor:
        """What ROS tools show of it; filled in anew for every declaration, as rclpy keeps it."""
        unit = f" [{self.unit}]" if self.unit else ""
        descriptor = ParameterDescriptor(description=self.about + unit, read_only=self.read_only)
        if self._limited and isinstance(self.default, float):
            limits = FloatingPointRange(from_value=self.least, to_value=self.most)
            descriptor.floating_point_range = [limits]
        elif self._limited:
            steps = IntegerRange(from_value=int(self.least), to_value=int(self.most), step=1)
            descriptor.integer_range = [steps]
        return descriptor

    def convert(self, value: object) -> Value:
        """Return a value in the parameter's type: an integer is a number too.

        Raises
        ------
        ParameterError
            If the value is of another type or out of the range.
        """
        kind = type(self.default)
        if kind is float and type(value) is int:
            value = float(value)
        if type(value) is not kind or not self._holds(value):
            raise ParameterError(f"{self.name} must be {self.allowed}, not {show(value)}")
        return value

    def _holds(self, value: Value) -> bool:
        """Return whether a value lies in the range; NaN lies in none."""
        if isinstance(value, str):
            return len(value) <= LONGEST_TEXT
        if not self._limited:
            return True
        return self.least <= value <= self.most

    @property
    def _limited(self) -> bool:
        return math.isfinite(self.least)


def _spec(part: object, name: str, key: str, rule: Rule) -> Spec:
    """Return the parameter of one entry of a part, to which it leaves what that may be."""
    return Spec(name, getattr(part, key), f"{rule.about}: {rule.allowed}")


# Others on the network may set parameters, but not name any file of the node's user.
_MACHINE_FILE = (
    "path of the machine file; while the node is unconfigured it can be changed to one below "
    "machine_folder"
)
_MACHINE_FOLDER = "folder below which machine_file can be changed; empty for not at all"
_STATE_FILE = "path of the file that outlives a restart, empty for none"

_STATE_MAX_AGE = (
    "time without speeds, over a restart or not, after which the branch that the machine was on "
    "is not believed any more"
)

_CURVE_HANG = "time without a new point of the curve after which its process is replaced"

_OIL_GRADE = "ISO viscosity grade of the oil whose temperature arrives, 0 for none"
_OIL_VISCOSITY = "kinematic viscosity of an oil without a grade at {} deg C, 0 for none"
_MEASURED_WARN = "difference of the measured orbit from the predicted one from which to warn"

SCHEMA = (
    Spec("machine_file", "", _MACHINE_FILE),
    Spec("machine_folder", "", _MACHINE_FOLDER, read_only=True),
    Spec("state_file", "", _STATE_FILE, read_only=True),
    Spec("state_max_age", 120.0, _STATE_MAX_AGE, "s", 1.0, 1e6),
    Spec("frame_id", "rotor", "frame of x and y in the headers of what is published"),
    Spec("harmonics", 7, "highest harmonic of the speed in the prediction", "", 1, 31),
    Spec("publish_rate", 100.0, "most predictions a second", "Hz", 0.1, 1000.0),
    Spec("stale_after", 1.0, "age of the last speed that ends the predictions", "s", 0.05, 3600.0),
    Spec("speed.min", 10.0, "lowest speed of the response curve", "rad/s", 0.1, 1e5),
    Spec("speed.max", 1000.0, "highest speed of the response curve", "rad/s", 0.1, 1e5),
    Spec("curve.detached", True, "whether to look for branches that no run-up meets, too"),
    Spec("curve.hang_after", 60.0, _CURVE_HANG, "s", 1.0, 3600.0),
    Spec("curve.attempts", 3, "attempts at a curve before it is given up", "", 1, 100),
    Spec("oil.grade", 0, _OIL_GRADE, "", 0, 1500),
    Spec("oil.viscosity_40", 0.0, _OIL_VISCOSITY.format(40), "mm2/s", 0.0, 1e5),
    Spec("oil.viscosity_100", 0.0, _OIL_VISCOSITY.format(100), "mm2/s", 0.0, 1e5),
    Spec("oil.density", 865.0, "density of the oil at 40 deg C", "kg/m3", 500.0, 2000.0),
    Spec("measured.warn", 0.15, _MEASURED_WARN, "of the orbit", 0.01, 2.0),
    Spec(
        "autostart",
        True,
        "whether the node configures and activates itself at the start",
        read_only=True,
    ),
    *(
        _spec(AlarmSettings(), f"alarm.{key}", key, rule)
        for key, rule in AlarmSettings.rules.items()
    ),
)


def machine_schema(machine: Machine) -> Iterator[Spec]:
    """Yield the machine's values that can be changed live, by their paths in the machine file.

    What a value may be is for the machine itself to say; the types alone are declared.
    """
    for damper in machine.dampers:
        for key in ("viscosity", "centering_stiffness"):
            yield _spec(damper, f"{damper.where}.{key}", key, Damper.rules[key])
    for unbalance in machine.unbalance:
        for key in ("magnitude", "phase"):
            yield _spec(unbalance, f"{unbalance.where}.{key}", key, Unbalance.rules[key])
    yield _spec(machine, "gravity", "gravity", Machine.rules["gravity"])
