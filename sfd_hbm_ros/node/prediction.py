"""Predictions of a machine whose values and loads change while it runs. Without ROS."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, JournalMotion, Solution
from sfd_hbm_ros.hbm.truncation import truncation_error
from sfd_hbm_ros.machine import Load, Machine, MachineError
from sfd_hbm_ros.node.inputs import Rim
from sfd_hbm_ros.response.errors import unexpected
from sfd_hbm_ros.response.tracking.tracked import Tracked
from sfd_hbm_ros.response.tracking.tracker import Tracker

AT_REST = "the rotor is at rest: there is nothing to predict"

PATIENCE = 0.4
"""Processor time that a prediction may take [s], lest all else wait for it."""

_ESTIMATE_EVERY = 5.0  # s, from one estimate of the truncation error to the next


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
    tracked : Tracked or None
        The operating point; None where there is no solution.
    truncation : float
        What more harmonics would add when that was last estimated, of the clearance; NaN where it
        is not known.
    bug : Exception or None
        What nobody expected on the way.
    """

    speed: float
    journals: Mapping[str, JournalMotion]
    failed: bool
    message: str
    residual: float = float("nan")
    iterations: int = 0
    seconds: float = 0.0
    tracked: Tracked | None = None
    truncation: float = float("nan")
    bug: Exception | None = None

    @property
    def others(self) -> Mapping[str, JournalMotion]:
        """The journals on the other stable branch; empty where none is known."""
        other = self.tracked.other if self.tracked else None
        return other.journals if other else {}


class Model:
    """A machine as configured, the loads that arrived for it, and where it is on its branches.

    Parameters
    ----------
    machine : Machine
        The machine.
    highest : int
        The highest harmonic to balance.

    Attributes
    ----------
    machine : Machine
        The machine with its present values, without the loads that arrived.
    harmonics : Harmonics
        The harmonics to balance.
    tracker : Tracker
        Follows the operating point.
    rim : Rim
        What moves fastest, which no value that can be changed alters.
    """

    def __init__(self, machine: Machine, highest: int) -> None:
        self.machine = machine
        self.rim = Rim.of(machine)
        self.harmonics = Harmonics(highest)
        self._loads: dict[str, Load] = {}
        self._balance: HarmonicBalance | None = None
        self._truncation, self._estimated = math.nan, -math.inf
        self.tracker = Tracker(self._build(), PATIENCE)

    @property
    def loads(self) -> dict[str, tuple[float, float]]:
        """The forces that arrived [N], by their stations."""
        return {station: load.force for station, load in self._loads.items()}

    @property
    def loaded(self) -> Machine:
        """The machine with all loads that act on it."""
        return _loaded(self.machine, self._loads)

    def loaded_by(self, forces: Mapping[str, tuple[float, float]]) -> Machine:
        """Return the machine as it would be under other forces [N] in place of those that came."""
        return _loaded(self.machine, {name: Load(name, force) for name, force in forces.items()})

    def change(self, machine: Machine, highest: int) -> None:
        """Go on with other values of the same machine and other harmonics."""
        self.machine = machine
        if highest != self.harmonics.highest:  # which keep what they have computed
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

    def add(self, load: Load) -> bool:
        """Let a load act, in place of any other at its station; tell whether it is another."""
        if self._acting(load.station) == load.force:
            return False
        self._loads[load.station] = load
        self._balance = None
        return True

    def balance(self) -> HarmonicBalance:
        """Return the equations of the machine under its loads, which the tracker now goes by."""
        if self._balance is None:
            self.tracker.change(self._build())
        assert self._balance is not None
        return self._balance

    def predict(self, speed: float, measured_at: float = math.nan) -> Prediction:
        """Follow the machine to a speed.

        Whatever goes wrong is told by the prediction: no exception is raised.

        Parameters
        ----------
        speed : float
            Rotor speed [rad/s].
        measured_at : float, optional
            When it was measured [s].
        """
        if speed == 0.0:
            return Prediction(speed, self.unknown(), False, AT_REST)
        start = time.perf_counter()
        try:
            # Where numbers overflow there is no solution: that is said, not warned about.
            with np.errstate(all="ignore"):
                self.balance()
        except (ArithmeticError, MachineError, np.linalg.LinAlgError) as error:
            # A machine beyond what numbers can hold.
            reason = f"the solver gave up: {type(error).__name__}: {error}"
            return Prediction(speed, self.unknown(), True, reason)
        except Exception as error:
            return Prediction(speed, self.unknown(), True, unexpected(error), bug=error)
        tracked = self.tracker.predict(speed, measured_at)
        solution = tracked.solution
        begun = solution.converged or solution.residuals
        return Prediction(
            speed,
            solution.journals,
            not solution.converged,
            solution.message if begun else f"the solver gave up: {solution.message}",
            solution.residual,
            solution.iterations,
            time.perf_counter() - start,
            tracked if solution.converged else None,
            self._truncation_error(solution) if solution.converged else math.nan,
            tracked.bug,
        )

    def _truncation_error(self, solution: Solution) -> float:
        """What more harmonics would add; it costs as much as a prediction, and changes slowly."""
        now = time.monotonic()
        if now - self._estimated > _ESTIMATE_EVERY:
            with np.errstate(all="ignore"):
                self._truncation = truncation_error(self.balance(), solution)
            self._estimated = now
        return self._truncation

    def _acting(self, station: str) -> tuple[float, float]:
        """The force at a station [N]."""
        if station in self._loads:
            return self._loads[station].force
        own = (load.force for load in self.machine.loads if load.station == station)
        return next(own, (0.0, 0.0))

    def _build(self) -> HarmonicBalance:
        self._balance = HarmonicBalance(self.loaded, self.harmonics)
        return self._balance

    def unknown(self) -> dict[str, JournalMotion]:
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
