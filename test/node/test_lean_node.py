"""What the predictor's node leaves undone, and that it leaves nothing behind."""

from .graph import JointState, Time, speed_message  # first of these, as it skips without ROS

# isort: split
from rclpy.event_handler import PublisherEventCallbacks

from sfd_hbm_ros.node.lean_node import LeanNode


def test_publishers_have_no_events_but_those_asked_for(graph):
    node = LeanNode("lean", context=graph.context)
    try:
        asked = PublisherEventCallbacks(incompatible_qos=print, use_default_callbacks=False)
        plain = node.create_publisher(JointState, "lean", 10)
        lifecycle = node.create_lifecycle_publisher(JointState, "lean", 10)
        eventful = node.create_publisher(JointState, "lean", 10, event_callbacks=asked)
        counts = [len(one.event_handlers) for one in (plain, lifecycle, eventful)]
        assert counts == [0, 0, 1]
        came = []
        graph.collect(JointState, "lean", came.append)
        message = speed_message(Time(nanoseconds=1), 2.0, 0.0)
        graph.until(lambda: came, "a message comes", lambda: plain.publish(message))
        assert came[0].velocity[0] == 2.0
    finally:
        node.destroy_node()


def test_nobody_sees_a_node_that_was_destroyed(graph):
    node = LeanNode("gone", context=graph.context)

    def seen() -> bool:
        return ("gone", "/") in graph.node.get_node_names_and_namespaces()

    graph.until(seen, "it is there")
    node.destroy_node()
    graph.until(lambda: not seen(), "it is gone")
