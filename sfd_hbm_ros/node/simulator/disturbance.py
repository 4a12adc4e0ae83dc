"""What happens to measurements on their way: noise, losses, wrong speeds and stamps. No ROS."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import Rule, integer, number

_SECOND = 1_000_000_000  # ns
_OFF = (1.0, 3600.0)  # s by which a wrong stamp lies in the past or the future
_PULSES = (0.5, 2.0)  # times the right speed: a pulse of the keyphasor was missed, or doubled


def _probability(about: str) -> Rule:
    return number(f"probability that a message {about}", least=0.0, below=1.0)


def _deviation(about: str, unit: str) -> Rule:
    return number(f"standard deviation of {about}", unit, least=0.0)


@dataclass(frozen=True)
class DisturbanceSettings(Part):
    """How measurements are disturbed; by default they are not.

    Raises
    ------
    MachineError
        If a value is not allowed.
    """

    speed_noise: Annotated[float, _deviation("the speeds", "rad/s")] = 0.0
    orbit_noise: Annotated[float, _deviation("each cosine and sine of a measured orbit", "m")] = (
        0.0
    )
    wrong_speed: Annotated[float, _probability("bears half or twice the speed")] = 0.0
    dropout: Annotated[float, _probability("is lost")] = 0.0
    wrong_stamp: Annotated[
        float, _probability("bears a stamp of 0, or from the past or the future")
    ] = 0.0
    seed: Annotated[int, integer("seed of what is random", least=0)] = 0


class Disturbance:
    """Disturbs measurements at random, the same way for the same seed.

    Parameters
    ----------
    settings : DisturbanceSettings
        How much.
    """

    def __init__(self, settings: DisturbanceSettings) -> None:
        self._settings = settings
        self._random = np.random.default_rng(settings.seed)

    def loses(self) -> bool:
        """Return whether the next message is lost."""
        return bool(self._random.random() < self._settings.dropout)

    def stamp(self, stamp: int) -> int:
        """Return the stamp [ns] that a message bears in place of the right one."""
        if self._random.random() >= self._settings.wrong_stamp:
            return stamp
        off = int(self._random.uniform(*_OFF) * _SECOND)
        return int(self._random.choice([0, max(stamp - off, 0), stamp + off]))

    def speed(self, speed: float) -> float:
        """Return a measured speed [rad/s], which is not negative."""
        if self._random.random() < self._settings.wrong_speed:
            speed *= self._random.choice(_PULSES)
        return max(0.0, speed + self._settings.speed_noise * self._random.standard_normal())

    def journals(self, journals: Mapping[str, JournalMotion]) -> dict[str, JournalMotion]:
        """Return measured motions of the journals."""
        return {name: self._measured(motion) for name, motion in journals.items()}

    def _measured(self, motion: JournalMotion) -> JournalMotion:
        noise = self._random.standard_normal(motion.coefficients.shape)
        return replace(
            motion, coefficients=motion.coefficients + self._settings.orbit_noise * noise
        )
