"""Parameters that are set while the predictor runs: checked, and taken to the machine."""

from __future__ import annotations

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from sfd_hbm_ros.machine import MachineError, override_all
from sfd_hbm_ros.node.curves import Curves
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.schema import ParameterError
from sfd_hbm_ros.node.watch import Watch

_SETTLED = ("machine_file", "state_file")  # parameters that stay while there is a machine


class Changes:
    """Checks parameters that are to be set, and lets those that have been set take effect.

    Parameters
    ----------
    node : Node
        The node.
    parameters : Parameters
        Its parameters.
    operation : Operation
        Who has the machine.
    curves : Curves
        Who knows its response curve.
    watch : Watch
        Who has the alarm.
    """

    def __init__(
        self,
        node: Node,
        parameters: Parameters,
        operation: Operation,
        curves: Curves,
        watch: Watch,
    ) -> None:
        self._parameters = parameters
        self._operation = operation
        self._curves = curves
        self._watch = watch
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        """Say whether parameters can be set, without setting anything."""
        model = self._operation.model
        try:
            self._parameters.check_together(parameters)
            if model is not None:
                _check_settled(parameters)
                override_all(model.machine, self._parameters.machine_values(parameters))
        except (MachineError, ParameterError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter]) -> None:
        """Let parameters that have been set take effect."""
        self._parameters.take(parameters)
        self._operation.update()
        self._watch.alarm.settings = self._parameters.alarm_settings()
        model, values = self._operation.model, self._parameters.machine_values(parameters)
        if model is not None and (values or any(p.name == "harmonics" for p in parameters)):
            self._operation.change(override_all(model.machine, values))
        self._curves.look()


def _check_settled(parameters: list[Parameter]) -> None:
    """Refuse what cannot be changed while there is a machine."""
    for parameter in parameters:
        if parameter.name in _SETTLED:
            raise ParameterError(
                f"{parameter.name} can only be changed while the node is unconfigured: clean it up"
            )
