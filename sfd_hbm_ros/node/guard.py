"""A node that no request and no message can end.

rclpy ends the process where a callback raises an exception, its own callbacks included: a
lifecycle transition that is not possible now, a parameter of a type that does not exist, or a
negative time on /clock is enough.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

Report = Callable[[Exception], None]


def answer_always(node: Node, report: Report) -> None:
    """Have every service of a node answer, with an empty response where it raised an exception.

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
            return response

    return answer
