"""The state file: what the predictor knows of its machine outlives its own end."""

from __future__ import annotations

import os
import time
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

from sfd_hbm_ros.machine.safe_file import put_aside, reason
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.lean_node import LeanNode
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.prediction import Model, Prediction
from sfd_hbm_ros.node.watch import Watch
from sfd_hbm_ros.response.errors import unexpected
from sfd_hbm_ros.response.tracking.state import State, restore
from sfd_hbm_ros.response.tracking.state_file import StateFileError, load_state, save_state
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.jump_log import JumpLog
from sfd_hbm_ros.response.warning.settings import Level

_PERIOD = 1.0  # s between two savings without a change worth more
_SOON = 0.1  # s after which what changed during a write is saved, where no speed comes
_LONGEST = 2.0  # s for which the node waits for a disk as it gives up its machine


class Memory:
    """Saves and restores the branch that the machine is on, its loads, its alarm and its jumps.

    A disk may be slow, so a thread writes; the newest state waits where it is still at the last.

    Parameters
    ----------
    node : LeanNode
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Who follows the machine.
    watch : Watch
        Who has the alarm.
    """

    def __init__(
        self, node: LeanNode, parameters: Parameters, operation: Operation, watch: Watch
    ) -> None:
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._watch = watch
        self._state: State | None = None
        self._path = ""
        self._refused = ""
        self._stays = ""  # why a refused file is where it was, so that nothing is written
        self._failed = ""
        self._saved: tuple[object, ...] = ()
        self._saved_at = 0.0
        self._written: State | None = None
        self._thread = ThreadPoolExecutor(1)
        self._writing: Future[None] | None = None
        # The state is taken before the watch looks at the alarm, so that what is saved at once
        # when that changes, or the machine has jumped, is the response after it.
        operation.after_prediction.insert(0, self._take)
        operation.after_prediction.append(lambda prediction, stamp: self._look())
        watch.after_change.append(self._look)
        # for what changed while a write was under way, when no speed comes after it
        node.create_timer(_SOON, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def restore(self, model: Model) -> None:
        """Begin with what is in the state file; one that is of no use is reported."""
        self._path, self._state = self._parameters["state_file"], None
        self._refused = self._stays = self._failed = ""
        if not self._path:
            return
        try:
            self._state = load_state(self._path, model.machine)
            if self._state is not None:
                self._restore(model, self._state)
        except StateFileError as error:
            self._refuse(str(error))
        except Exception as error:  # whatever is in it, the node goes on without
            self._node.mishaps.take(error, secret=True)
            self._refuse(f"{self._path}: refused: its state does not fit the machine")

    def save(self) -> None:
        """Save the state now, and wait until that is done."""
        self._collect(wait=True)
        if self._writing is None:
            self._write()
            self._collect(wait=True)

    def release(self) -> None:
        """Save the state of the machine that is given up."""
        self.save()
        self._path, self._state = "", None
        self._refused = self._stays = self._failed = ""

    def added_to(self, status: Status) -> Status:
        """Return the status of the model with how its memory fares."""
        values = {**status.values, "state_file": self._path}
        problem = "; ".join(part for part in (self._refused, self._stays, self._failed) if part)
        if not problem:
            return replace(status, values=values)
        values["state_file: problem"] = problem
        message = f"{status.message}; state file {problem}"
        return replace(status, level=max(status.level, Level.WARN), message=message, values=values)

    def _restore(self, model: Model, state: State) -> None:
        """Go on from a state."""
        try:
            model.rim.check(state.speed, self._parameters["speed.max"])
        except InputError as error:
            raise StateFileError(f"{self._path}: refused: {error}") from None
        watch = self._watch
        alarm = JumpAlarm.from_dict(watch.alarm.settings, state.alarm, time.monotonic())
        jumps = JumpLog.from_dict(state.jumps)
        loads = [model.checked_load(*given) for given in state.loads.items()]
        watch.alarm, watch.jumps = alarm, jumps
        # A clock that does not run yet, as one of a simulation, tells nothing; a speed will.
        now = int(self._node.get_clock().now().nanoseconds)
        problem = self._operation.too_old((now - state.stamp) * 1e-9) if now else ""
        if problem:
            self._refused = f"{self._path}: branch and loads are not believed: {problem}"
            self._node.get_logger().warning(f"state file {self._refused}")
            return
        for load in loads:
            self._operation.add(load)
        restored = restore(state, model.balance())
        if restored.same:
            self._operation.remembered = state.stamp
            if state.settled:
                model.tracker.settle(restored.solution)
            else:
                model.tracker.assume(restored.solution, state.origin)
            return
        if not state.settled:
            return
        self._refused = f"{self._path}: the machine has changed, so that its branch is not known"
        self._node.get_logger().warning(f"state file {self._refused}")

    def _refuse(self, problem: str) -> None:
        """Go on without the file, and put it aside lest it be overwritten."""
        self._state, self._refused = None, problem
        try:
            put_aside(self._path)
        except FileNotFoundError:
            pass
        except (OSError, ValueError) as error:
            why = f"it could not be put aside ({reason(error)})"
            self._stays = f"nothing is written while it is there, as {why}"
        problem = "; ".join(part for part in (self._refused, self._stays) if part)
        self._node.get_logger().warning(f"state file {problem}")

    def _take(self, prediction: Prediction, stamp: int) -> None:
        """Remember a prediction."""
        model = self._operation.model
        tracked = prediction.tracked
        if not self._path or model is None or tracked is None or not tracked.verified:
            return
        solution = tracked.solution
        self._state = State(
            solution.speed,
            solution.harmonics,
            solution.coefficients,
            model.tracker.settled,
            stamp,
            {},  # the alarm's, when it is saved
            model.loads,
            origin=model.tracker.origin,
        )

    def _look(self) -> None:
        """Save the state if something important has changed, or it is new and a second passed."""
        self._collect()
        if self._writing is not None:
            return
        due = time.monotonic() - self._saved_at >= _PERIOD
        if self._key != self._saved or (due and self._state is not self._written):
            self._write()

    @property
    def _key(self) -> tuple[object, ...]:
        """What is saved at once when it changes."""
        prediction = self._operation.believed
        tracked = prediction.tracked if prediction else None
        settled = self._state.settled if self._state else None
        return *self._watch.signature, settled, tracked.branch if tracked else None

    def _write(self) -> None:
        """Have the thread write the state, if there is any."""
        model, now = self._operation.model, time.monotonic()
        if not self._path or model is None or self._state is None:
            return
        self._saved, self._saved_at, self._written = self._key, now, self._state
        if self._stays and os.path.lexists(self._path):
            return
        self._stays = ""
        alarm, jumps = self._watch.alarm.to_dict(now), self._watch.jumps.to_dict()
        state = replace(self._state, alarm=alarm, jumps=jumps)
        self._writing = self._thread.submit(save_state, self._path, model.machine, state)

    def _collect(self, wait: bool = False) -> None:
        """Find out what became of the last writing, if it is done."""
        if self._writing is None or not (wait or self._writing.done()):
            return
        failed = ""
        try:
            self._writing.result(_LONGEST)
        except TimeoutError:
            self._failed = f"{self._path}: not yet written after {_LONGEST:g} s"
            return
        except StateFileError as error:
            failed = str(error)
            self._node.get_logger().error(f"state file {failed}", throttle_duration_sec=_PERIOD)
        except Exception as error:
            self._node.mishaps.take(error)
            failed = f"{self._path}: {unexpected(error)}"
        self._writing, self._failed = None, failed
