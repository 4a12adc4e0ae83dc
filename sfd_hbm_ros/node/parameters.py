"""The predictor's parameters as ROS holds them: declared, converted and given back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from sfd_hbm_ros.machine import Machine, MachineError, override_all
from sfd_hbm_ros.machine.errors import show_key, unknown
from sfd_hbm_ros.machine.oil import Oil
from sfd_hbm_ros.node.schema import SCHEMA, ParameterError, Spec, machine_schema
from sfd_hbm_ros.node.unbalance import LIST_SCHEMA, LISTS, ListSpec, agreed, everywhere, listed
from sfd_hbm_ros.response.warning.settings import AlarmSettings

_SECTIONS = ("dampers", "unbalance", "gravity")


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
        self._specs = {spec.name: spec for spec in SCHEMA}
        self._machine: dict[str, Spec | ListSpec] = {}
        for spec in SCHEMA:
            self._declare(spec, self._first_value(spec))
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
        machine = everywhere(machine)
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
        return machine

    def release(self) -> None:
        """Undeclare the values of the machine."""
        for name in self._machine:
            self._node.undeclare_parameter(name)
        self._machine = {}

    def converted(self, parameters: Iterable[Parameter]) -> list[Parameter]:
        """Return parameters that are to be set, in the types that they were declared with.

        Those of unbalances come in both of their ways.

        Raises
        ------
        ParameterError
            If one is unknown, of the wrong type or out of its range, or lists do not go together.
        """
        taken = {one.name: self._converted(one) for one in parameters}
        known = {name: self[name] for name in self._machine}
        values = agreed({name: one.value for name, one in taken.items()}, known)
        return [taken.get(name) or _parameter(name, value) for name, value in values.items()]

    def machine_values(self, parameters: Iterable[Parameter]) -> dict[str, Any]:
        """Return the values of the machine among parameters, by their paths."""
        single = self._machine.keys() - set(LISTS)
        return {p.name: p.value for p in parameters if p.name in single}

    def take(self, parameters: Sequence[Parameter]) -> None:
        """Note that parameters have been set, which amends what was given at the start."""
        for parameter in parameters:
            self._refused.pop(parameter.name, None)

    def _converted(self, parameter: Parameter) -> Parameter:
        """Return one parameter in the type that it was declared with."""
        known = self._specs | self._machine
        if parameter.name in known:
            value = known[parameter.name].convert(parameter.value)
            return _parameter(parameter.name, value)
        if self._node.has_parameter(parameter.name):  # of every node, as use_sim_time is
            return parameter
        raise ParameterError(f"{show_key(parameter.name)} {unknown(parameter.name, known)}")

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
        known = self._specs | self._machine
        for name in given:
            if name not in known and not self._node.has_parameter(name):
                self._node.get_logger().warning(
                    f"parameter {show_key(name)} {unknown(name, known)}; it has no effect"
                )


def _parameter(name: str, value: Any) -> Parameter:
    """Return a parameter; the type of an empty list is not seen from its value."""
    kind = next((spec.kind for spec in LIST_SCHEMA if spec.name == name), None)
    if kind is None:
        return Parameter(name, value=value)
    types = {str: Parameter.Type.STRING_ARRAY, float: Parameter.Type.DOUBLE_ARRAY}
    return Parameter(name, types[kind], value)
