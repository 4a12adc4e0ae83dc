"""Predictions of a machine whose values and loads change while it runs. Without ROS."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, JournalMotion, Solution, solve
from sfd_hbm_ros.machine import Load, Machine

AT_REST = "the rotor is at rest: there is nothing to predict"


@dataclass(frozen=True)
class Prediction:
    """The motion of the journals at one speed, or why it is not known.

    Attributes
    ----------
    speed : float
        Rotor speed [rad/s].
    journals : mapping of str to JournalMotion
        By the damper's name; NaN where there is no solution.
    failed : bool
        Whether a solution was sought and not found.
    message : str
        The outcome as a sentence.
    residual : float
        What is left of the forces, relative to the load.
    iterations : int
        Newton steps of the last attempt.
    seconds : float
        Time it took [s].
    """

    speed: float
    journals: Mapping[str, JournalMotion]
    failed: bool
    message: str
    residual: float = float("nan")
    iterations: int = 0
    seconds: float = 0.0


class Model:
    """A machine as configured, the loads that arrived for it, and its last solution.

    Parameters
    ----------
    machine : Machine
        The machine.
    highest : int
        The highest harmonic to balance.
    """

    def __init__(self, machine: Machine, highest: int) -> None:
        self.machine = machine
        self.harmonics = Harmonics(highest)
        self._loads: dict[str, Load] = {}
        self._last: Solution | None = None
        self._balance: HarmonicBalance | None = self._build()

    def change(self, machine: Machine, highest: int) -> None:
        """Go on with other values of the same machine and other harmonics."""
        self.machine = machine
        self.harmonics = Harmonics(highest)
        self._balance = None

    def checked_load(self, station: str, force: tuple[float, float]) -> Load:
        """Return the load of a constant force [N] at a station.

        Raises
        ------
        MachineError
            If the machine has no such station or the force is not finite.
        """
        load = Load(station, force)
        _loaded(self.machine, {station: load})
        return load

    def add(self, load: Load) -> None:
        """Let a load act, in place of any other at its station."""
        self._loads[load.station] = load
        self._balance = None

    def forget(self) -> None:
        """Begin anew with the next prediction: what the machine did meanwhile is not known."""
        self._last = None

    def predict(self, speed: float) -> Prediction:
        """Predict the motion at a speed [rad/s] from the last solution.

        Whatever goes wrong is told by the prediction: no exception is raised.
        """
        if speed == 0.0:
            return Prediction(speed, self._unknown(), False, AT_REST)
        start = time.perf_counter()
        try:
            # Where numbers overflow there is no solution: that is said, not warned about.
            with np.errstate(all="ignore"):
                if self._balance is None:
                    self._balance = self._build()
                solution = solve(self._balance, speed, self._last)
        except Exception as error:  # a speed or a machine beyond what numbers can hold
            reason = f"the solver gave up: {type(error).__name__}: {error}"
            return Prediction(speed, self._unknown(), True, reason)
        if solution.converged:
            self._last = solution
        return Prediction(
            speed,
            solution.journals,
            not solution.converged,
            solution.message,
            solution.residual,
            solution.iterations,
            time.perf_counter() - start,
        )

    def _build(self) -> HarmonicBalance:
        """Return the equations of the machine under its loads."""
        return HarmonicBalance(_loaded(self.machine, self._loads), self.harmonics)

    def _unknown(self) -> dict[str, JournalMotion]:
        """Return motions that are not known."""
        return {
            damper.name: JournalMotion(
                damper.name,
                damper.clearance,
                self.harmonics,
                np.full((self.harmonics.rows, 2), np.nan),
            )
            for damper in self.machine.dampers
        }


def _loaded(machine: Machine, loads: Mapping[str, Load]) -> Machine:
    """Return the machine with its own loads, those at the given stations replaced."""
    own = {load.station: load for load in machine.loads}
    return replace(machine, loads=tuple({**own, **loads}.values()))
