"""Messages of measured orbits, which bear the names of the predicted harmonics."""

from __future__ import annotations

import math
import re

from sensor_msgs.msg import JointState

from sfd_hbm_ros.machine.errors import show, show_key
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages.common import named

# The mean, or the amplitude or phase of an order above 0 without leading or trailing zeros.
_ORDER = r"(?:[1-9][0-9]{0,3}|(?:0|[1-9][0-9]{0,3})\.[0-9]{0,5}[1-9])"
_NAME = re.compile(rf"[^/]+/[xy]/(?:0x|{_ORDER}x/(?:amplitude|phase))")


def read_measured(message: JointState) -> dict[str, float]:
    """Return the measured harmonics of all dampers, named as in `harmonics_message`.

    A phase needs its amplitude; without a keyphasor there are amplitudes alone. A phase that is
    NaN was not measured, and is left out.

    Raises
    ------
    InputError
        If there is none, names and numbers do not pair, a name occurs twice or is not that of a
        harmonic, a phase lacks its amplitude, or a number is not finite or a negative amplitude.
    """
    measured: dict[str, float] = {}
    for name, value in named(message):
        if not _NAME.fullmatch(name):
            raise InputError(
                f"{show(name)} must be the name of a harmonic: DAMPER/x/0x, "
                "DAMPER/x/1x/amplitude, DAMPER/x/1x/phase or the like"
            )
        if math.isnan(value) and name.endswith("/phase"):
            continue
        is_amplitude = name.endswith("/amplitude")
        if not math.isfinite(value) or (is_amplitude and value < 0.0):
            allowed = "finite number of at least 0" if is_amplitude else "finite number"
            raise InputError(f"{show_key(name)} must be a {allowed}, not {value}")
        if name in measured:
            raise InputError(f"{show_key(name)} must be given once")
        measured[name] = value
    if not message.name:
        raise InputError("name must hold the names of measured harmonics, it is empty")
    if not measured:
        raise InputError("position must hold measured numbers, they are all NaN")
    for name in measured:
        stem, _, part = name.rpartition("/")
        if part == "phase" and f"{stem}/amplitude" not in measured:
            raise InputError(f"{show_key(name)} must come with its amplitude")
    return measured
