"""What a supervisor hears of a predictor that is stuck, goes on, and dies."""

import itertools
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from .graph import HEARTBEAT, LIMIT, Graph, Header, Remote, Time, strings

# isort: split
from rcl_interfaces.srv import SetParameters
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile

from sfd_hbm_ros.node.reporter import Heart

from .bistable import BOTH, UPPER_ONLY, given
from .process import PAPER_ROTOR

LEASE = 1.0  # s
BEATS = QoSProfile(depth=1000)


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


class Beats:
    """The stamps of a predictor's heartbeats, which are kept while others wait."""

    def __init__(self, graph: Graph, topic: str) -> None:
        self._graph = graph
        self._stamps: list[int] = []
        take = self._stamps.append
        graph.collect(
            Header, topic, lambda message: take(Time.from_msg(message.stamp).nanoseconds), BEATS
        )

    def longest(self, work: Callable[[], Any]) -> float:
        """Return the longest time between two heartbeats [s] while some work goes on."""
        self._graph.until(lambda: self._stamps, "the heart beats")
        del self._stamps[:-1]
        work()
        done = self._graph.node.get_clock().now().nanoseconds
        self._graph.until(lambda: self._stamps[-1] > done, "the heart beats on")
        pairs = itertools.pairwise(self._stamps)
        return max(later - earlier for earlier, later in pairs) * 1e-9

    def holds(self, work: Callable[[], Any]) -> None:
        """Check that it is not taken for dead meanwhile, on whatever computer this is."""
        end = time.monotonic() + 3.0
        idle = self.longest(lambda: self._graph.until(lambda: time.monotonic() > end, "3 s"))
        assert self.longest(work) < max(LEASE, 3.0 * idle)


@pytest.fixture(scope="module")
def beating(graph, start, tmp_path_factory) -> tuple[Remote, Beats, Path]:
    """A predictor of a bistable machine, whose curve has come, and a folder for its files."""
    folder = tmp_path_factory.mktemp("beating")
    start(*given(folder, f"machine_folder:={folder}"), "-r", "__node:=beating")
    remote = Remote(graph, "/beating")
    remote.meet(UPPER_ONLY)
    graph.until(
        lambda: remote.curves,
        "a curve comes",
        between=lambda: remote.send(UPPER_ONLY, remote.now()),
    )
    return remote, Beats(graph, "/beating/heartbeat"), folder


@pytest.fixture
def busy() -> Iterator[None]:
    """Keep the computer busy with twice as many processes as it has processors."""
    command = [sys.executable, "-c", "while True: pass"]
    processes = [subprocess.Popen(command) for _ in range(2 * (os.cpu_count() or 1))]
    yield
    for process in processes:
        process.kill()
        process.wait()


def test_the_heart_beats_while_twenty_thousand_values_are_set(graph, beating):
    remote, beats, _ = beating
    values = [Parameter("gravity", value=i % 2 > 0).to_parameter_msg() for i in range(20_000)]
    request = SetParameters.Request(parameters=values)
    answers = []
    beats.holds(
        lambda: answers.append(
            graph.call(SetParameters, f"{remote.name}/set_parameters", request).results
        )
    )
    [results] = answers
    assert len(results) == 20_000
    assert {one.reason for one in results} == {
        "a request may set at most 1000 parameters, not 20000"
    }
    assert not any(one.successful for one in results)


def test_the_heart_beats_while_a_search_uses_all_its_time(graph, beating, busy):
    """The worker process stands still: without a curve, loads far away are sought for long."""
    remote, beats, _ = beating
    worker = int(strings(remote.statuses["Model"])["worker: process"])
    os.kill(worker, signal.SIGSTOP)

    def loads() -> None:
        for force in (1e4, -1e4, 2e4):
            stamp = remote.now()
            remote.push("damper_1", (0.0, force), stamp)
            remote.send(BOTH, stamp)
            remote.answer(stamp)

    try:
        beats.holds(loads)
    finally:
        os.kill(worker, signal.SIGCONT)


def test_the_heart_beats_while_a_large_machine_is_read_and_built(beating):
    remote, beats, folder = beating
    text = PAPER_ROTOR.read_text()
    machine = yaml.safe_load(text)
    [segment] = machine["shaft"]
    segment["elements"] = 1
    machine["shaft"] = [
        {**segment, "outer_diameter": 0.0319 + 1e-7 * i, "length": 0.001 + 1e-9 * i}
        for i in range(600)
    ]
    for section in ("disks", "bearings", "dampers"):
        for part in machine[section]:
            part["node"] *= 25
    large = folder / "large.yaml"
    large.write_text(yaml.safe_dump(machine))
    before = remote.get("machine_file")[0]

    def change(file: str) -> None:
        assert remote.change_state("deactivate", "cleanup") == [True] * 2
        assert remote.set({"machine_file": file}).successful
        assert remote.change_state("configure", "activate") == [True] * 2
        remote.predict(300.0)

    beats.holds(lambda: change(str(large)))
    change(before)


def test_a_heart_stops_with_the_work_of_its_thread():
    beats: list[float] = []
    heart = Heart(lambda: beats.append(time.monotonic()))

    def until(condition: Callable[[], bool], step: bool) -> None:
        end = time.monotonic() + LIMIT
        while not condition():
            assert time.monotonic() < end
            if step:
                heart.step()
            time.sleep(0.05)

    until(lambda: len(beats) > 5, step=True)
    until(lambda: time.monotonic() - beats[-1] > 1.0, step=False)
    stopped = len(beats)
    until(lambda: len(beats) > stopped + 5, step=True)
    heart.stop()
