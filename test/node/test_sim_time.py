"""The predictor follows /clock: none yet, running, set back, and nonsense."""

from functools import partial

import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time as TimeMessage
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from .graph import Remote
from .process import PAPER_ROTOR

WARN = b"\x01"
SECOND = 10**9


def test_simulated_time(graph, start):
    process = start(
        *("-p", f"machine_file:={PAPER_ROTOR}", "-p", "use_sim_time:=true"),
        *("-p", "stale_after:=60.0", "-r", "__node:=simulated"),
    )
    remote = Remote(graph, "/simulated")
    clock = graph.node.create_publisher(Clock, "/clock", 1)

    def at(time: int) -> None:
        clock.publish(Clock(clock=Time(nanoseconds=time).to_msg()))

    def until_at(time: int, stamp: int) -> None:
        """Let it be a time, and a speed with a stamp arrive, until the prediction is there."""
        remote.harmonics.clear()
        expected = stamp or time

        def again() -> None:
            at(time)
            remote.send(300.0, stamp)

        graph.until(lambda: expected in remote.harmonics, f"predicts at {time}", between=again)

    graph.until(
        lambda: "/clock" in inputs(remote),
        "says that there is no time",
        between=lambda: remote.send(300.0, SECOND),
    )
    remote.beats()
    assert not remote.harmonics

    until_at(100 * SECOND, 100 * SECOND)
    until_at(101 * SECOND, 0)  # no stamp: the time of receipt

    for stamp, reason in ((99, "before that of an earlier one"), (111, "10 s in the future")):
        again = partial(remote.send, 300.0, stamp * SECOND)
        remote.until_status("Inputs", WARN, reason, between=again)

    until_at(20 * SECOND, 20 * SECOND)  # set back, as where a recording starts again

    nonsense = partial(clock.publish, Clock(clock=TimeMessage(sec=-5)))
    remote.until_status("Inputs", WARN, "must not be negative", between=nonsense)
    until_at(30 * SECOND, 30 * SECOND)
    assert process.running


def inputs(remote: Remote) -> str:
    status = remote.statuses.get("Inputs")
    return status.message if status else ""
