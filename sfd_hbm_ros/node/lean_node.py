"""A lifecycle node that leaves the executor little to do, nothing behind and no request out."""

from __future__ import annotations

from typing import Any

from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.publisher import Publisher
from rclpy.qos import qos_profile_parameters
from rclpy.service import Service

from sfd_hbm_ros.node.guard import Mishaps

_LIFECYCLE = {
    "change_state": ChangeState,
    "get_state": GetState,
    "get_available_states": GetAvailableStates,
    "get_available_transitions": GetAvailableTransitions,
    "get_transition_graph": GetAvailableTransitions,
}

_QUEUE = qos_profile_parameters  # reliable, of depth 1000


class LeanNode(LifecycleNode):
    """A lifecycle node for many peers.

    Its publishers have no events but those that are asked for. rclpy has every publisher log
    subscribers whose quality of service does not fit, as those do themselves. Before every
    callback the executor would look for such events, at each publisher.

    Its services have room for a thousand requests, as those of parameters have. With the default,
    ten, the eleventh that comes to a service during one callback replaces the first, which is
    never answered.

    Attributes
    ----------
    mishaps : Mishaps
        Exceptions that nobody handles.
    """

    def __init__(self, name: str, **options: Any) -> None:
        # The services of the life cycle would have the default, whatever is asked for.
        super().__init__(name, enable_communication_interface=False, **options)
        self.mishaps = Mishaps(self)
        for service, kind in _LIFECYCLE.items():
            answer = getattr(self, f"_LifecycleNodeMixin__on_{service}")
            self.create_service(kind, f"~/{service}", answer)

    def create_service(self, *arguments: Any, **options: Any) -> Service:
        """See `Node`."""
        return super().create_service(*arguments, **{"qos_profile": _QUEUE, **options})

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
