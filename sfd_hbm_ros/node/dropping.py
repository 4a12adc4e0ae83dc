"""Inputs that turn out to be unusable: counted, and said why."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.node import Node

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.node.inputs import Drops, InputError

_LOG_PAUSE = 5.0  # s between two log messages about bad input


@contextmanager
def dropping(node: Node, drops: Drops) -> Iterator[None]:
    """Count an input that raises `InputError` or `MachineError`, and log why it is dropped."""
    try:
        yield
    except (InputError, MachineError) as error:
        drops.drop(str(error), time.monotonic())
        text = f"dropped from {drops.source}: {error}"
        node.get_logger().warning(text, throttle_duration_sec=_LOG_PAUSE)
