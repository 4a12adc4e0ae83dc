"""The machine that the simulator plays, and that on the branches of its curve. Without ROS."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from sfd_hbm_ros.hbm import JournalMotion, Solution
from sfd_hbm_ros.node.simulator.speed_profile import SpeedProfile
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.units import RPM


class JumpError(ValueError):
    """Why a machine cannot be thrown onto another response, in one sentence."""


class PlayedMachine(Protocol):
    """A machine on a run."""

    def advance(self, time: float, patience: float) -> float:
        """Go on to a time [s] of the run, and return the time reached.

        That is less where going on takes longer than the patience [s] of real time.
        """

    def journals(self) -> Mapping[str, JournalMotion]:
        """Return the motions of the journals at the time reached, by their dampers' names.

        Raises
        ------
        NoSolutionError
            If it has none.
        """

    def jump(self) -> str:
        """Be thrown onto another stable response, and return a sentence that tells of it.

        Raises
        ------
        JumpError
            If there is none.
        """


class BareSpeed:
    """No machine: a run of which nothing but the speed is known."""

    def advance(self, time: float, patience: float) -> float:
        """Return the time."""
        return time

    def journals(self) -> Mapping[str, JournalMotion]:
        """Return nothing."""
        return {}

    def jump(self) -> str:
        """Say why there is no jump."""
        raise JumpError("no machine is simulated: machine_file is empty")


class TrackedMachine:
    """A machine that stays on the stable branches of its response curve, and jumps at their ends.

    Parameters
    ----------
    curve : ResponseCurve
        The curve, over all speeds of the run.
    profile : SpeedProfile
        The run.
    """

    def __init__(self, curve: ResponseCurve, profile: SpeedProfile) -> None:
        self._profile = profile
        self._tracker = Tracker(curve.balance)
        self._tracker.adopt(curve)
        self._time = 0.0

    def advance(self, time: float, patience: float) -> float:
        """Go on to a time [s] of the run, which takes no time."""
        self._time = time
        return time

    def journals(self) -> Mapping[str, JournalMotion]:
        """Return the motions of the journals."""
        tracked = self._tracker.predict(self._speed)
        if not tracked.solution.converged:
            raise NoSolutionError(tracked.solution.message)
        return tracked.solution.journals

    def jump(self) -> str:
        """Be on the other stable response from now on."""
        tracked = self._tracker.predict(self._speed)
        if tracked.other is None:
            raise no_other(self._speed)
        self._tracker.settle(tracked.other)
        return thrown(tracked.solution.eccentricity_max, tracked.other)

    @property
    def _speed(self) -> float:
        return self._profile.speed(self._time)


def thrown(eccentricity: float, onto: Solution) -> str:
    """Return the sentence about a machine thrown onto a response, from an eccentricity."""
    change = f"from eccentricity {eccentricity:.3f} to {onto.eccentricity_max:.3f}"
    return f"thrown {change} at {onto.speed / RPM:.0f} rpm"


def no_other(speed: float) -> JumpError:
    """Return the error of a machine that has one stable response at a speed [rad/s]."""
    return JumpError(f"there is no other stable response at {speed / RPM:.0f} rpm")
