"""Messages of measured orbits, which bear the names of the predicted harmonics."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Mapping
from typing import NamedTuple

from sensor_msgs.msg import JointState

from sfd_hbm_ros.machine.errors import show, show_key
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages import named

Measured = dict[str, dict[tuple[str, float], complex]]
"""Complex amplitudes Q [m] of q = Re(Q exp(i w t)), by damper, then axis ("x", "y") and order.

Orders have the six digits of their names: 0.333333 is a third.
"""

# The mean, or the amplitude or phase of an order above 0 without leading or trailing zeros.
_ORDER = r"[1-9][0-9]{0,3}|(?:0|[1-9][0-9]{0,3})\.[0-9]{0,5}[1-9]"
_NAME = re.compile(rf"([^/]+)/([xy])/(?:0x|({_ORDER})x/(amplitude|phase))")


def read_measured(message: JointState) -> Measured:
    """Return the measured harmonics of all dampers, named as in `harmonics_message`.

    Raises
    ------
    InputError
        If names and numbers do not pair, a name occurs twice or is not that of a harmonic, an
        amplitude lacks its phase or the phase its amplitude, or a number is not finite or a
        negative amplitude.
    """
    parts: dict[_Harmonic, dict[str, float]] = {}
    for name, value in named(message):
        harmonic, part = _parsed(name)
        if not math.isfinite(value) or (part == "amplitude" and value < 0.0):
            allowed = "finite number of at least 0" if part == "amplitude" else "finite number"
            raise InputError(f"{show_key(name)} must be a {allowed}, not {value}")
        if part in parts.setdefault(harmonic, {}):
            raise InputError(f"{show_key(name)} must be given once")
        parts[harmonic][part] = value
    measured: Measured = {}
    for harmonic, values in parts.items():
        measured.setdefault(harmonic.damper, {})[harmonic[1:]] = _amplitude(harmonic, values)
    return measured


class _Harmonic(NamedTuple):
    damper: str
    axis: str
    order: float

    def __str__(self) -> str:
        return f"{show_key(self.damper)}/{self.axis}/{self.order:g}x"


def _parsed(name: str) -> tuple[_Harmonic, str]:
    """Return the harmonic of a name, and which part of it is named."""
    match = _NAME.fullmatch(name)
    if match is None:
        raise InputError(
            f"{show(name)} must be the name of a harmonic: DAMPER/x/0x, DAMPER/x/1x/amplitude, "
            "DAMPER/x/1x/phase or the like"
        )
    damper, axis, order, part = match.groups()
    return _Harmonic(damper, axis, float(order or 0.0)), part or "mean"


def _amplitude(harmonic: _Harmonic, values: Mapping[str, float]) -> complex:
    """Return the complex amplitude of a harmonic; its phase is a lag."""
    match values:
        case {"mean": mean}:
            return complex(mean)
        case {"amplitude": amplitude, "phase": phase}:
            return cmath.rect(amplitude, -phase)
    [given] = values
    missing = "phase" if given == "amplitude" else "amplitude"
    raise InputError(f"{harmonic}/{missing} is missing beside {harmonic}/{given}")
