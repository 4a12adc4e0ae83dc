"""A lifecycle node that leaves the executor little to do, and nothing behind."""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import PublisherEventCallbacks
from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.publisher import Publisher


class LeanNode(LifecycleNode):
    """A lifecycle node whose publishers have no events but those that are asked for.

    rclpy has every publisher log subscribers whose quality of service does not fit, as those do
    themselves. Before every callback the executor would look for such events, at each publisher.
    """

    def destroy_node(self) -> None:
        """See `Node`; rclpy would leave the state machine, by which others see the node yet."""
        super().destroy_node()
        self._state_machine.destroy_when_not_in_use()

    def create_publisher(self, *arguments: Any, **options: Any) -> Publisher:
        """See `Node`."""
        return super().create_publisher(*arguments, **_without_events(options))

    def create_lifecycle_publisher(self, *arguments: Any, **options: Any) -> LifecyclePublisher:
        """See `LifecycleNode`."""
        options = _without_events(options)
        publisher: LifecyclePublisher = super().create_lifecycle_publisher(*arguments, **options)
        return publisher


def _without_events(options: dict[str, Any]) -> dict[str, Any]:
    """Options of a publisher, without events unless they are asked for."""
    return {"event_callbacks": PublisherEventCallbacks(use_default_callbacks=False), **options}
