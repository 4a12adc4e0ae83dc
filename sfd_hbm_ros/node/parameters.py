"""The predictor's parameters as ROS holds them: declared, converted and given back."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from sfd_hbm_ros.machine import Machine, MachineError, get, override_all
from sfd_hbm_ros.machine.errors import hint, show, show_key
from sfd_hbm_ros.machine.oil import Oil
from sfd_hbm_ros.node.schema import SCHEMA, ParameterError, Spec, machine_schema
from sfd_hbm_ros.node.unbalance import LIST_SCHEMA, LISTS, ListSpec, agreed, everywhere, listed
from sfd_hbm_ros.response.warning.settings import AlarmSettings
from sfd_hbm_ros.units import RPM

_SECTIONS = ("dampers", "unbalance", "gravity")
_RANGE = ("speed.min", "speed.max")


class Parameters:
    """The parameters of a node, and those given at its start that it could not take.

    Parameters
    ----------
    node : Node
        The node, to which the parameters that do not depend on the machine are declared.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        # rclpy has no public way to ask for them: its automatic declaration ends the node where
        # a parameter file holds an empty list.
        self._given = {name: p.value for name, p in node._parameter_overrides.items()}
        self._refused: dict[str, str] = {}
        self._chosen: set[str] = set()  # what has been set since the start
        self._specs = {spec.name: spec for spec in SCHEMA}
        self._machine: dict[str, Spec | ListSpec] = {}
        self._file: Machine | None = None  # what the machine file holds
        for spec in SCHEMA:
            self._declare(spec, self._first_value(spec))
        self._first_file = self["machine_file"]
        self._warn(name for name in self._given if name.partition(".")[0] not in _SECTIONS)

    def __getitem__(self, name: str) -> Any:
        """Return the value of a parameter."""
        return self._node.get_parameter(name).value

    def check_given(self) -> None:
        """Check that what was given at the start has been taken, or set since.

        Raises
        ------
        ParameterError, MachineError
            If it was not allowed, or does not go together.
        """
        if self._refused:
            raise ParameterError("; ".join(self._refused.values()))
        self.check_together()

    def check_file(self, path: str) -> None:
        """Check that a machine file may be read: that given at the start, or one below the folder.

        Raises
        ------
        ParameterError
            If it may not.
        """
        folder = self["machine_folder"]
        if path == self._first_file:
            return
        if not folder:
            raise ParameterError(
                f"machine_file is fixed, as no machine_folder is set: {_restart('machine_file')}"
            )
        try:
            below = os.path.realpath(path).startswith(os.path.join(os.path.realpath(folder), ""))
        except (OSError, ValueError):
            below = False
        if not below:
            raise ParameterError(
                f"machine_file must be a file below machine_folder, {folder}, not {show(path)}"
            )

    def check_together(self, parameters: Iterable[Parameter] = ()) -> None:
        """Check that the parameters go together when some have been set.

        Raises
        ------
        ParameterError, MachineError
            If they do not.
        """
        values = {parameter.name: parameter.value for parameter in parameters}
        self.alarm_settings(values)
        self.oil(values)
        lowest, highest = (values.get(name, self[name]) for name in ("speed.min", "speed.max"))
        if not lowest < highest:
            raise ParameterError(
                f"speed.max must be above speed.min, {lowest:g} rad/s, not {highest:g}"
            )

    def alarm_settings(self, values: Mapping[str, Any] | None = None) -> AlarmSettings:
        """Return the settings of the alarm, where some values take precedence.

        Raises
        ------
        MachineError
            If they do not go together.
        """
        given = {key: f"alarm.{key}" for key in AlarmSettings.rules}
        try:
            return AlarmSettings(
                **{key: (values or {}).get(name, self[name]) for key, name in given.items()}
            )
        except MachineError as error:
            raise error.at("alarm") from None

    def oil(self, values: Mapping[str, Any] | None = None) -> Oil | None:
        """Return the oil that is configured, if any, where some values take precedence.

        Raises
        ------
        MachineError
            If there is no such oil.
        """
        names = ("oil.grade", "oil.viscosity_40", "oil.viscosity_100", "oil.density")
        return Oil.configured(*((values or {}).get(name, self[name]) for name in names))

    def adopt(self, machine: Machine) -> Machine:
        """Declare the values of a machine, and return it with those given at the start.

        It gets an unbalance at every station, of 0 where it has none.

        Raises
        ------
        ParameterError, MachineError
            If a value given at the start is not allowed.
        """
        self._file = machine = everywhere(machine)
        single = list(machine_schema(machine))
        schema: list[Spec | ListSpec] = [*single, *LIST_SCHEMA]
        default = {spec.name: spec.default for spec in single}
        known = {**default, **listed(default)}
        given = {
            spec.name: spec.convert(self._given[spec.name])
            for spec in schema
            if spec.name in self._given
        }
        values = {**known, **agreed(given, known)}
        machine = override_all(machine, {spec.name: values[spec.name] for spec in single})
        for spec in schema:
            self._declare(spec, values[spec.name])
            self._machine[spec.name] = spec
        self._warn(name for name in self._given if name.partition(".")[0] in _SECTIONS)
        self._set_range(machine.operating_speed_rpm)
        return machine

    def release(self) -> None:
        """Undeclare the values of the machine."""
        with suppress(ParameterError):  # where what was chosen allows no other
            self._set_range([float(self._specs[name].default) / RPM for name in _RANGE])
        for name in self._machine:
            self._node.undeclare_parameter(name)
        self._machine, self._file = {}, None

    def converted(self, parameters: Iterable[Parameter]) -> list[Parameter]:
        """Return parameters that are to be set, in the types that they were declared with.

        Those of unbalances come in both of their ways, and those that are fixed not at all: they
        can only be as they are.

        Raises
        ------
        ParameterError
            If one is unknown, fixed, of the wrong type or out of its range, or lists do not go
            together.
        """
        given = [self._converted(one) for one in parameters]
        taken = {one.name: one for one in given if not self._read_only(one.name)}
        known = {name: self[name] for name in self._machine}
        values = agreed({name: one.value for name, one in taken.items()}, known)
        return [taken.get(name) or _parameter(name, value) for name, value in values.items()]

    def check(self, parameter: Parameter) -> None:
        """Check a parameter that is to be set, whatever else is.

        Raises
        ------
        ParameterError
            If it is unknown, fixed, of the wrong type or out of its range.
        """
        self._converted(parameter)

    def machine_values(self, parameters: Iterable[Parameter]) -> dict[str, Any]:
        """Return the values of the machine among parameters, by their paths."""
        single = self._machine.keys() - set(LISTS)
        return {p.name: p.value for p in parameters if p.name in single}

    def take(self, parameters: Sequence[Parameter]) -> None:
        """Note that parameters have been set, which amends what was given at the start."""
        for parameter in parameters:
            self._refused.pop(parameter.name, None)
        self._chosen |= {parameter.name for parameter in parameters}

    def _set_range(self, rpm: Sequence[float]) -> None:
        """Let the speed have another range [rpm], but for what a user has chosen; none if empty.

        Raises
        ------
        ParameterError
            If that does not go together.
        """
        chosen = self._chosen | self._given.keys()
        values = {
            name: min(max(value * RPM, self._specs[name].least), self._specs[name].most)
            for name, value in zip(_RANGE, rpm, strict=False)
            if name not in chosen
        }
        values = {name: value for name, value in values.items() if value != self[name]}
        if not values:
            return
        result = self._node.set_parameters_atomically(
            [Parameter(name, value=value) for name, value in values.items()]
        )
        self._chosen -= values.keys()
        if not result.successful:
            raise ParameterError(result.reason)

    def _converted(self, parameter: Parameter) -> Parameter:
        """Return one parameter in the type that it was declared with."""
        name, known = parameter.name, self._known
        if name in known:
            parameter = _parameter(name, known[name].convert(parameter.value))
        elif not self._node.has_parameter(name):  # of every node, as use_sim_time is
            raise ParameterError(f"{show_key(name)} {self._unknown(name)}")
        if self._read_only(name) and parameter.value != self[name]:
            raise ParameterError(f"{name} is fixed: {_restart(name)}")
        if name == "machine_file" and parameter.value != self[name]:
            self.check_file(parameter.value)
        return parameter

    @property
    def _known(self) -> dict[str, Spec | ListSpec]:
        return self._specs | self._machine

    def _read_only(self, name: str) -> bool:
        return bool(self._node.describe_parameter(name).read_only)

    def _unknown(self, name: str) -> str:
        """Say why there is no parameter of a name, and what else there is to do."""
        if self._file is not None and _holds(self._file, name):
            return (
                "is fixed while there is a machine: change it in the machine file, then clean the "
                "node up and configure it"
            )
        if self._file is None and name.partition(".")[0] in _SECTIONS:
            return "is unknown while the node is unconfigured: it comes with the machine file"
        near = hint(name, self._known)
        return f"is unknown{near or '; `ros2 param list` shows those that there are'}"

    def _first_value(self, spec: Spec) -> Any:
        """Return the value given at the start, or the default if that is refused."""
        try:
            return spec.convert(self._given.get(spec.name, spec.default))
        except ParameterError as error:
            self._refused[spec.name] = str(error)
            return spec.default

    def _declare(self, spec: Spec | ListSpec, value: Any) -> None:
        """Declare a parameter to ROS."""
        self._node.declare_parameter(spec.name, value, spec.descriptor, ignore_override=True)

    def _warn(self, given: Iterable[str]) -> None:
        """Warn of parameters given at the start that the node does not know."""
        for name in given:
            if name not in self._known and not self._node.has_parameter(name):
                self._node.get_logger().warning(
                    f"parameter {show_key(name)} {self._unknown(name)}; it has no effect"
                )


def _restart(name: str) -> str:
    """Say how to change what is read at the start only."""
    return f"it is read when the node starts, so restart the node with -p {name}:=VALUE"


def _holds(machine: Machine, path: str) -> bool:
    """Return whether a machine file has an entry."""
    try:
        get(machine, path)
    except MachineError:
        return False
    return True


def _parameter(name: str, value: Any) -> Parameter:
    """Return a parameter; the type of an empty list is not seen from its value."""
    kind = next((spec.kind for spec in LIST_SCHEMA if spec.name == name), None)
    if kind is None:
        return Parameter(name, value=value)
    types = {str: Parameter.Type.STRING_ARRAY, float: Parameter.Type.DOUBLE_ARRAY}
    return Parameter(name, types[kind], value)
