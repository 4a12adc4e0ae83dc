"""The simulator's parameters as ROS holds them: taken at the start, shown and never changed."""

from __future__ import annotations

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.machine.errors import show_key, unknown
from sfd_hbm_ros.machine.parts import read
from sfd_hbm_ros.node.simulator.simulation import Settings

Values = dict[str, object]


def take(node: Node) -> tuple[Settings, Values]:
    """Return the settings given to a node at its start, and the values of its machine.

    Those are named by their paths in the machine file and take precedence over it. Parameters
    that have no effect are warned about.

    Raises
    ------
    MachineError
        If a setting is not allowed; the values are not checked.
    """
    given = {name: parameter.value for name, parameter in node._parameter_overrides.items()}
    known = {name: value for name, value in given.items() if name in Settings.rules}
    settings = read(Settings, known, "")
    values = {n: value for n, value in given.items() if n.partition(".")[0] in Machine.rules}
    for name in given:
        if name in values and not settings.machine_file:
            _warn(node, name, "needs a machine_file")
        elif name not in (*known, *values) and not node.has_parameter(name):  # as use_sim_time
            _warn(node, name, unknown(name, Settings.rules))
    return settings, values


def declare(node: Node, settings: Settings, values: Values) -> None:
    """Show the settings and the values, and what they mean, as parameters that stay."""
    for key, rule in Settings.rules.items():
        _show(node, key, getattr(settings, key), f"{rule.about}: {rule.allowed}")
    for path, value in values.items():
        _show(node, path, value, "value of the machine file, by its path there")


def _show(node: Node, name: str, value: object, about: str) -> None:
    descriptor = ParameterDescriptor(description=about, read_only=True)
    node.declare_parameter(name, value, descriptor, ignore_override=True)


def _warn(node: Node, name: str, problem: str) -> None:
    text = f"parameter {show_key(name)} {problem}; it has no effect"
    node.get_logger().warning(text)
