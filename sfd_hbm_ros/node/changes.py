"""Parameters that are set while the predictor runs: checked, and taken to the machine."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

from sfd_hbm_ros.machine import MachineError, override_all
from sfd_hbm_ros.machine.errors import show_key
from sfd_hbm_ros.node.curves import Curves
from sfd_hbm_ros.node.operation import Operation
from sfd_hbm_ros.node.parameters import Parameters
from sfd_hbm_ros.node.schema import ParameterError
from sfd_hbm_ros.node.watch import Watch

_MOST = 1000  # parameters that a request may set
_PATIENCE = 0.2  # s within which those of a request are looked at, and set one by one
_TOO_LONG = "not looked at, as the request takes too long: send fewer parameters at a time"


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
        self._node = node
        self._parameters = parameters
        self._operation = operation
        self._curves = curves
        self._watch = watch
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)
        # rclpy's own would answer nothing where a single parameter has no type.
        answers = {SetParameters: self._set, SetParametersAtomically: self._set_together}
        for service in node.services:
            service.callback = answers.get(service.srv_type, service.callback)

    def _set(self, request: SetParameters.Request, response: Any) -> Any:
        """Set parameters, each for itself: at once where they go together, else in their order."""
        messages = request.parameters
        if len(messages) > _MOST:
            response.results = [_refused(_too_many(messages))] * len(messages)
            return response
        end = time.monotonic() + _PATIENCE
        results: list[SetParametersResult | None] = [None] * len(messages)
        good: dict[int, Parameter] = {}
        for index, message in enumerate(messages):
            try:
                if time.monotonic() > end:
                    raise ParameterError(_TOO_LONG)
                parameter = _read(message)
                self._parameters.check(parameter)
                good[index] = parameter
            except ParameterError as error:
                results[index] = _refused(str(error))
        together = self._node.set_parameters_atomically(list(good.values()))
        for index, parameter in good.items():
            if together.successful:
                results[index] = together
            elif time.monotonic() < end:
                results[index] = self._node.set_parameters_atomically([parameter])
            else:
                results[index] = _refused(_TOO_LONG)
        response.results = results
        return response

    def _set_together(self, request: SetParametersAtomically.Request, response: Any) -> Any:
        """Set parameters, all or none."""
        messages = request.parameters
        try:
            if len(messages) > _MOST:
                raise ParameterError(_too_many(messages))
            parameters = [_read(message) for message in messages]
        except ParameterError as error:
            response.result = _refused(str(error))
        else:
            response.result = self._node.set_parameters_atomically(parameters)
        return response

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        """Say whether parameters can be set, without setting anything."""
        model = self._operation.model
        try:
            self._parameters.check_together(parameters)
            if model is not None:
                self._check_file(parameters)
                override_all(model.machine, self._parameters.machine_values(parameters))
        except (MachineError, ParameterError) as error:
            return _refused(str(error))
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

    def _check_file(self, parameters: list[Parameter]) -> None:
        """Refuse another machine file while there is a machine."""
        name = "machine_file"
        if any(p.name == name and p.value != self._parameters[name] for p in parameters):
            raise ParameterError(
                f"{name} can only be changed while the node is unconfigured: clean it up"
            )


def _too_many(messages: Sequence[ParameterMessage]) -> str:
    return f"a request may set at most {_MOST} parameters, not {len(messages)}"


def _refused(reason: str) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=reason)


def _read(message: ParameterMessage) -> Parameter:
    """Return a parameter as it came.

    Raises
    ------
    ParameterError
        If its type is none that there is.
    """
    try:
        parameter: Parameter = Parameter.from_parameter_msg(message)
    except ValueError:
        raise ParameterError(
            f"{show_key(message.name)} must have a type of ParameterType, not {message.value.type}"
        ) from None
    return parameter
