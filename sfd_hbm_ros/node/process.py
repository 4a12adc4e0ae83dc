"""A node as a process: signals end it cleanly, its user's mistakes with one sentence."""

import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TypeVar

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions, get_current_signal_handlers_options
from rclpy.task import Future
from rclpy.utilities import get_default_context, try_shutdown

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.threads import one_blas_thread

N = TypeVar("N", bound=Node)

BAD_INPUT = 2
"""Exit code where the command line or a parameter is wrong."""


def run(name: str, make: Callable[[], N], work: Callable[[N], int]) -> int:
    """Make a node, let it work and return the exit code of the process.

    Parameters
    ----------
    name : str
        Who speaks in the sentence about a mistake.
    make : callable
        Returns the node; raises MachineError if its parameters are wrong.
    work : callable
        Spins the node and returns the exit code.

    Returns
    -------
    int
        What `work` returned, 0 after SIGINT or SIGTERM, or 2 with a sentence on standard error
        for wrong arguments or parameters.
    """
    try:
        with one_blas_thread, _interrupts_left_to_rclpy(), warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: get_logger(name).warning(str(message))
            try:
                node = _made(name, make)
                return BAD_INPUT if node is None else work(node)
            finally:
                # After a signal rclpy shuts down in a thread of its own, and fails where that is
                # faster.
                with suppress(RuntimeError):
                    try_shutdown()
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0


def spin_until(node: Node, finished: Future) -> None:
    """Spin a node until a future is done, or its context ends.

    rclpy's own `spin_until_future_complete` keeps a callback for every event that it serves, some
    40 MiB an hour at 50 Hz.
    """
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    finished.add_done_callback(lambda _: executor.wake())
    while node.context.ok() and not finished.done():
        executor.spin_once()


@contextmanager
def _interrupts_left_to_rclpy() -> Iterator[None]:
    """Have SIGINT end the process as SIGTERM does: between two callbacks.

    rclpy shuts its context down and then calls Python's own handler, whose KeyboardInterrupt would
    come in the midst of anything, such as the start of a thread.
    """

    def interrupt(*_: object) -> None:
        if get_current_signal_handlers_options() == SignalHandlerOptions.NO:
            raise KeyboardInterrupt  # as rclpy is not up yet, or not any more

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _made(name: str, make: Callable[[], N]) -> N | None:
    """Return the node, or nothing after a sentence about its user's mistake."""
    try:
        rclpy.init()
    except RuntimeError as error:  # as rcl's errors are
        _complain(name, f"bad ROS arguments: {error}")
        return None
    try:
        return make()
    except Exception as error:
        if not get_default_context().ok():
            raise ExternalShutdownException from error  # a signal came while it was made
        if not isinstance(error, (MachineError, ParameterException, RuntimeError)):
            raise
        _complain(name, str(error))
        return None


def _complain(name: str, mistake: str) -> None:
    """Print a sentence on standard error."""
    print(f"{name}: {mistake}", file=sys.stderr)
