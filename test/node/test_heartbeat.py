"""What a supervisor hears of a predictor that is stuck, goes on, and dies."""

import signal

import pytest

from .graph import HEARTBEAT, Graph, Header, Remote

# isort: split
from rclpy.event_handler import SubscriptionEventCallbacks

from .process import PAPER_ROTOR


class Supervisor:
    """Demands the documented deadline and liveliness of a heartbeat.

    Attributes
    ----------
    missed : int
        Deadlines that were missed.
    alive : bool
        Whether the heart counts as beating.
    """

    def __init__(self, graph: Graph, topic: str) -> None:
        self.missed, self.alive = 0, False
        graph.node.create_subscription(
            Header,
            topic,
            lambda _: None,
            HEARTBEAT,
            event_callbacks=SubscriptionEventCallbacks(
                deadline=self._on_deadline, liveliness=self._on_liveliness
            ),
        )

    def _on_deadline(self, event) -> None:
        self.missed = event.total_count

    def _on_liveliness(self, event) -> None:
        self.alive = event.alive_count > 0


@pytest.fixture
def supervisor(graph) -> Supervisor:
    return Supervisor(graph, "/watched/heartbeat")


def test_deadline_and_liveliness_tell_of_a_stuck_and_of_a_dead_predictor(graph, start, supervisor):
    process = start("-p", f"machine_file:={PAPER_ROTOR}", "-r", "__node:=watched")
    remote = Remote(graph, "/watched")
    remote.meet()
    graph.until(lambda: supervisor.alive, "the heart beats")

    process.send(signal.SIGSTOP)
    missed = supervisor.missed
    graph.until(lambda: supervisor.missed > missed, "a deadline is missed")
    graph.until(lambda: not supervisor.alive, "the heart does not beat any more")

    process.send(signal.SIGCONT)
    graph.until(lambda: supervisor.alive, "the heart beats again")
    remote.predict(300.0)

    assert process.stop(signal.SIGKILL) == -signal.SIGKILL
    missed = supervisor.missed
    graph.until(lambda: supervisor.missed > missed, "another deadline is missed")
    graph.until(lambda: not supervisor.alive, "the heart has stopped")
