"""The lifecycle node `predictor`: its states, its parameters and what it says about itself."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

from rcl_interfaces.msg import SetParametersResult
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter

from sfd_hbm_ros.kernels import load_kernels
from sfd_hbm_ros.machine import Machine, MachineError, read_machine
from sfd_hbm_ros.node import diagnostics, guard
from sfd_hbm_ros.node.changes import Changes
from sfd_hbm_ros.node.curves import Curves
from sfd_hbm_ros.node.lean_node import LeanNode
from sfd_hbm_ros.node.measurement import Measurement
from sfd_hbm_ros.node.memory import Memory
from sfd_hbm_ros.node.oil_feed import OilFeed
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.orbit import Orbits
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.process import run
from sfd_hbm_ros.node.reporter import Reporter
from sfd_hbm_ros.node.schema import ParameterError
from sfd_hbm_ros.node.self_test import SelfTestService
from sfd_hbm_ros.node.watch import Watch
from sfd_hbm_ros.node.what_if import WhatIf
from sfd_hbm_ros.node.worker.status import with_worker
from sfd_hbm_ros.response.errors import NoSolutionError, unexpected
from sfd_hbm_ros.rotor import ResonanceError

_SUCCESS = TransitionCallbackReturn.SUCCESS
# What a machine may be that cannot be predicted; anything else is a bug.
_BAD_MACHINE = (MachineError, ParameterError, NoSolutionError, ResonanceError, ArithmeticError)


class Predictor(LeanNode):
    """Predicts how the journals move at the speed and under the loads that arrive.

    The README has its topics, config/predictor.yaml its parameters.

    Parameters
    ----------
    prepare : callable, optional
        Called when the node has all that others see of it, before it configures itself: DDS makes
        it known meanwhile.
    """

    def __init__(self, prepare: Callable[[], None] = lambda: None) -> None:
        super().__init__("predictor")
        self._label = "unconfigured"
        self._problem = ""
        # not _parameters, which rclpy's Node has of its own
        self._known = Parameters(self)
        self._operation = Operation(self, self._known)
        self._curves = Curves(self, self._known, self._operation)
        self._watch = Watch(self, self._operation, self._curves, self._hardware)
        Changes(self, self._known, self._operation, self._curves, self._watch)
        self._memory = Memory(self, self._known, self._operation, self._watch)
        Orbits(self, self._operation)
        self._what_if = WhatIf(self, self._known, self._operation, self._curves)
        self._measurement = Measurement(self, self._known, self._operation)
        self._oil = OilFeed(self, self._known, self._operation)
        SelfTestService(self)
        self._reporter = Reporter(self, self._hardware, self._statuses)
        guard.answer_always(self, self.mishaps.take)
        prepare()
        if self._known["autostart"] and self.trigger_configure() == _SUCCESS:
            self.trigger_activate()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Read the machine file; a bad one leaves the node unconfigured."""
        try:
            self._known.check_given()
            path = self._known["machine_file"]
            if not path:
                raise ParameterError("machine_file must be the path of a machine file, not empty")
            self._known.check_file(path)
            machine = _read_machine(path)
            self._reporter.step()  # each of these takes a while for a large machine
            machine = self._known.adopt(machine)
            self._reporter.step()
            self._watch.alarm.settings = self._known.alarm_settings()
            model = self._operation.begin(machine)
            self._reporter.step()
            self._memory.restore(model)
        except Exception as error:  # whatever it is, the node stays up and says it
            known = isinstance(error, _BAD_MACHINE)
            if not known:
                self.mishaps.take(error)
            self._release("unconfigured")
            self._problem = str(error) if known else unexpected(error)
            self.get_logger().error(f"cannot be configured: {self._problem}")
            return TransitionCallbackReturn.FAILURE
        self._label, self._problem = "inactive", ""
        self.get_logger().info(f"configured with {path}")
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to predict."""
        self._label, self._operation.active = "active", True
        self.get_logger().info("active")
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Predict no more; loads and values are still taken."""
        self._label = "inactive"
        self._memory.save()
        self._operation.stop()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the machine with all that was changed in it."""
        self._release("unconfigured")
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the machine for good."""
        self._release("finalized")
        return super().on_shutdown(state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Return to the start after a transition that raised an exception."""
        self._release("unconfigured")
        return super().on_error(state)

    def _release(self, label: str) -> None:
        """Give up the machine."""
        self._label, self._problem = label, ""
        self._memory.release()
        self._operation.release()
        self._curves.release()
        self._watch.release()
        self._known.release()

    def close(self) -> None:
        """Save what is to outlive the process, and end the worker process."""
        self._memory.release()
        self._curves.worker.close()
        self._reporter.close()

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters together, or none for a reason; both parameter services end here.

        Where there is a machine, the reason of what is done is the revision of the machine then.
        """
        try:
            converted = self._known.converted(parameter_list)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        done = SetParametersResult(successful=True)  # where all are as they were
        if converted:
            done = super().set_parameters_atomically(converted)
        if done.successful and self._operation.model is not None:
            done.reason = f"revision {self._curves.revision}"
        return done

    def _hardware(self) -> str:
        """Return the name of the machine's file, in every state: its title may be a sentence."""
        return Path(self._known["machine_file"]).stem

    def _statuses(self) -> list[diagnostics.Status]:
        """Return how the node fares."""
        work = self._operation
        model = diagnostics.model_status(
            self._label, self._problem, self._known["machine_file"], work.model
        )
        model = with_worker(self._curves.added_to(model), self._curves.worker)
        return [
            self._watch.status(),
            self._measurement.added_to(self._memory.added_to(self.mishaps.added_to(model))),
            diagnostics.solver_status(work.prediction, work.predictions, work.failures),
            self._curves.range_in(
                diagnostics.inputs_status(
                    work.active,
                    work.speed,
                    [
                        work.load,
                        self._measurement.feed,
                        self._oil.feed,
                        self._what_if.drops,
                        self.mishaps.requests,
                    ],
                    self._known["stale_after"],
                    time.monotonic(),
                )
            ),
        ]


def _read_machine(path: str) -> Machine:
    """Read a machine file; what it holds is not told, as everybody can read what the node says."""
    try:
        return read_machine(path)
    except MachineError as error:
        raise ParameterError(error.discreet()) from None


def main() -> int:
    """Run the predictor until SIGINT or SIGTERM."""
    # Kernels are loaded at the start, as a prediction cannot wait for it.
    return run("predictor", lambda: Predictor(load_kernels), _spin)


def _spin(predictor: Predictor) -> int:
    try:
        guard.spin(predictor, predictor.mishaps.take)
    finally:
        predictor.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
