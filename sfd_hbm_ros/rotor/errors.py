"""What can go wrong with a valid rotor."""

from __future__ import annotations


class ResonanceError(ArithmeticError):
    """A harmonic meets an undamped resonance of the shaft with its journals held.

    Parameters
    ----------
    order : float
        The harmonic, as a multiple of the speed.
    speed : float
        Rotor speed [rad/s].
    """

    def __init__(self, order: float, speed: float) -> None:
        self.order, self.speed = order, speed
        super().__init__(
            f"harmonic {order:g} of the speed {speed:g} rad/s is exactly an undamped resonance of "
            "the shaft with its dampers' journals held; a slightly different speed has a solution"
        )
