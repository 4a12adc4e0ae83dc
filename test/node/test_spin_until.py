"""Spinning until a future is done, for as long as that takes."""

import pytest

from .graph import Context, Graph, rclpy  # first, as it skips the file without ROS

# isort: split
from rclpy.task import Future

from sfd_hbm_ros.node.process import spin_until


@pytest.fixture
def graph_of_its_own(domain):
    graph = Graph()
    yield graph
    graph.close()


def test_it_keeps_nothing_of_the_events_that_it_has_served(graph_of_its_own):
    finished, kept = Future(), []

    def tick() -> None:
        kept.append(len(finished._callbacks))
        if len(kept) == 200:
            finished.set_result(None)

    graph_of_its_own.node.create_timer(1e-3, tick)
    spin_until(graph_of_its_own.node, finished)
    assert kept == [1] * 200


def test_it_ends_with_its_context(domain):
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node("short_lived", context=context)
    node.create_timer(1e-3, context.try_shutdown)
    finished = Future()
    spin_until(node, finished)
    assert not finished.done()
    node.destroy_node()
