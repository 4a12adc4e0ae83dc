"""A node that no request and no message can end.

rclpy ends the process where a callback raises an exception, its own callbacks included: a
lifecycle transition that is not possible now, or a negative time on /clock is enough. Such a
request is refused. What this package itself raises and nobody expects is a bug, and told as one.
"""

from __future__ import annotations

import inspect
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

from sfd_hbm_ros.node.diagnostics import RECENT, Status
from sfd_hbm_ros.node.inputs import Drops
from sfd_hbm_ros.response.warning.settings import Level

Report = Callable[[Exception], None]

_PACKAGE = __name__.partition(".")[0]
_LOG_PAUSE = 5.0  # s between two log messages about refused requests
_SAME_PAUSE = 60.0  # s between two log messages about the same bug
_MOST_KINDS = 100  # of bugs that are told apart


class Mishaps:
    """Exceptions that callbacks raised: counted, logged and survived.

    Parameters
    ----------
    node : Node
        Whose they are.

    Attributes
    ----------
    requests : Drops
        What rclpy would not do, since it came to it in a state or with a value that is not
        possible.
    bugs : Drops
        What nobody expected; the log has the traceback.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.requests = Drops("requests")
        self.bugs = Drops("unexpected errors")
        self._logged: dict[tuple[str, int], float] = {}

    def take(self, error: Exception, secret: bool = False) -> None:
        """Take an exception.

        Parameters
        ----------
        error : Exception
            The exception.
        secret : bool
            Whether its text may quote what is not to be told.
        """
        now = time.monotonic()
        frames = traceback.extract_tb(error.__traceback__)
        text = type(error).__name__ if secret else f"{type(error).__name__}: {error}"
        if not secret and not _is_ours(error):
            self.requests.drop(text, now)
            self._node.get_logger().error(f"caught {text}", throttle_duration_sec=_LOG_PAUSE)
            return
        self.bugs.drop(text, now)
        place = (frames[-1].filename, frames[-1].lineno or 0) if frames else ("", 0)
        if now - self._logged.get(place, -_SAME_PAUSE) < _SAME_PAUSE:
            return
        if len(self._logged) >= _MOST_KINDS:
            self._logged.clear()
        self._logged[place] = now
        stack = "".join(traceback.format_list(frames))
        self._node.get_logger().error(
            f"unexpected error, please report it: {text}\nTraceback, the last call last:\n{stack}"
        )

    def added_to(self, status: Status) -> Status:
        """Return a status with the number of bugs, and a warning of a recent one."""
        values = {**status.values, "unexpected errors": str(self.bugs.dropped)}
        if not self.bugs.dropped:
            return replace(status, values=values)
        values["last unexpected error"] = self.bugs.reason
        if self.bugs.since_drop(time.monotonic()) > RECENT:
            return replace(status, values=values)
        message = f"{status.message}; unexpected error, see the log: {self.bugs.reason}"
        return replace(status, level=max(status.level, Level.WARN), message=message, values=values)


def answer_always(node: Node, report: Report) -> None:
    """Have every service of a node answer, with the reason where it raised an exception.

    Parameters
    ----------
    node : Node
        The node with all its services made.
    report : callable
        Is told the exception.
    """
    for service in node.services:
        service.callback = _answering(service.callback, report)


def spin(node: Node, report: Report) -> None:
    """Spin a node until the end of its context, whatever its callbacks raise.

    Parameters
    ----------
    node : Node
        The node.
    report : callable
        Is told the exceptions.
    """
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    while node.context.ok():
        try:
            executor.spin()
        except ExternalShutdownException:
            raise
        except Exception as error:
            if node.context.ok():
                report(error)


def _answering(callback: Callable[..., Any], report: Report) -> Callable[..., Any]:
    """Return a service's callback that does not raise."""

    async def answer(request: Any, response: Any) -> Any:
        try:
            answered = callback(request, response)
            return await answered if inspect.isawaitable(answered) else answered
        except Exception as error:
            report(error)
            return refused(request, response, f"refused: {type(error).__name__}: {error}")

    return answer


def refused(request: Any, response: Any, reason: str) -> Any:
    """Return the response of a service that says why it refuses, as far as its type has words.

    Parameters
    ----------
    request, response : object
        The request and an empty response, of any type of service.
    reason : str
        The reason.
    """
    result = SetParametersResult(successful=False, reason=reason)
    fields = response.get_fields_and_field_types()
    if "message" in fields and "success" in fields:  # std_srvs
        response.success, response.message = False, reason
    elif fields.get("result") == "rcl_interfaces/SetParametersResult":
        response.result = result
    elif "results" in fields:
        response.results = [result] * len(request.parameters)
    elif "passed" in fields and "status" in fields:  # diagnostic_msgs/SelfTest
        response.status = [DiagnosticStatus(level=DiagnosticStatus.ERROR, message=reason)]
    return response


def _is_ours(error: Exception) -> bool:
    """Return whether an exception came by way of this package, but for this module."""
    modules = (frame.f_globals["__name__"] for frame, _ in traceback.walk_tb(error.__traceback__))
    return any(name.startswith(f"{_PACKAGE}.") and name != __name__ for name in modules)
