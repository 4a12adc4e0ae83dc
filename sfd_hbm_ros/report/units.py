"""Units and numbers as people read them."""

import math

HERTZ = 2.0 * math.pi
"""One cycle a second [rad/s]."""

MICROMETRE = 1e-6
"""[m]."""

_THIN_SPACE = "\u2009"


def grouped(number: float) -> str:
    """A number with its thousands set apart."""
    return f"{number:,.10g}".replace(",", _THIN_SPACE)


def length_text(metres: float) -> str:
    """A small length for people, in millimetres from one on and in micrometres below."""
    return f"{1e3 * metres:.4g} mm" if metres >= 1e-3 else f"{metres / MICROMETRE:.4g} um"
