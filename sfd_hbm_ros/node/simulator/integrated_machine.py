"""The machine that the simulator plays by time integration. Without ROS."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping

import numpy as np

from sfd_hbm_ros.hbm import Harmonics, JournalMotion
from sfd_hbm_ros.node.simulator.played_machine import no_other, thrown
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.integrator import ClearanceError, Integrator
from sfd_hbm_ros.response.integration.options import SAMPLES
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.tracking.guide import Guide
from sfd_hbm_ros.units import RPM


class IntegratedMachine:
    """A machine integrated in time, revolution by revolution.

    Its journals' motions are those of the last whole revolution.

    Parameters
    ----------
    curve : ResponseCurve
        The curve, over all speeds of the run: the machine starts on it, and is thrown onto it.
    profile : SpeedProfile
        The run.

    Raises
    ------
    NoSolutionError
        If the curve has no stable response at the start.
    """

    def __init__(self, curve: ResponseCurve, profile: SpeedProfile) -> None:
        self._profile = profile
        self._guide = Guide(curve.balance, curve)
        self._integrator = Integrator(curve.balance, profile.to_rpm * RPM)
        self._harmonics = Harmonics(curve.balance.harmonics.highest, SAMPLES)
        place = self._guide.run_up(profile.speed(0.0)).place
        start = self._guide.solved(place) if place else None
        if start is None:
            raise NoSolutionError(f"no stable response to start from at {profile.from_rpm:g} rpm")
        self._state = self._integrator.start(start)
        angles = self._harmonics.angles(SAMPLES)
        self._orbit = np.hstack([motion.at(angles) for motion in start.journals.values()])
        self._revolutions = 0
        self._begin, self._end = 0.0, self._time_after(1)  # of the next revolution

    def advance(self, time: float, patience: float) -> float:
        """Integrate all revolutions that end before a time [s] of the run."""
        deadline = clock.perf_counter() + patience
        while self._end <= time:
            if clock.perf_counter() >= deadline:
                return self._begin
            self._revolve()
        return time

    def journals(self) -> Mapping[str, JournalMotion]:
        """Return the motions of the journals."""
        coefficients = self._harmonics.projection @ self._orbit
        return {
            damper.name: JournalMotion(
                damper.name, damper.clearance, self._harmonics, coefficients[:, 2 * i : 2 * i + 2]
            )
            for i, damper in enumerate(self._guide.balance.machine.dampers)
        }

    def jump(self) -> str:
        """Go on from the stable response of the curve that is the next but one to the orbit."""
        speed = self._profile.speed(self._begin)
        eccentricity = max(motion.eccentricity_max for motion in self.journals().values())
        for place in self._guide.others(speed, None, eccentricity)[1:]:
            onto = self._guide.solved(place)
            if onto is not None:
                self._state = self._integrator.start(onto)
                return thrown(eccentricity, onto)
        raise no_other(speed)

    def _revolve(self) -> None:
        """Integrate the next revolution, with the run's speeds at its begin and end."""
        first, last = self._profile.speed(self._begin), self._profile.speed(self._end)
        ramp = Ramp(first, (last**2 - first**2) / (2.0 * math.tau), 1)
        try:
            self._state, self._orbit = self._integrator.revolution(ramp, 0, self._state)
        except ClearanceError as error:
            raise NoSolutionError(f"{error}, at {last / RPM:g} rpm") from error
        self._revolutions += 1
        self._begin, self._end = self._end, self._time_after(self._revolutions + 1)

    def _time_after(self, revolutions: int) -> float:
        """Return the time [s] of the run after a number of revolutions."""
        near = self._end if revolutions > 1 else 0.0
        return self._profile.time(math.tau * revolutions, near)
