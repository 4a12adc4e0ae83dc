"""A predictor by another clock: none at first, then one ten times fast, set back under way."""

import math
import time
from collections import defaultdict

import pytest

from .graph import Graph, Remote, Strings, Time, strings

# isort: split
from rosgraph_msgs.msg import Clock

from .bistable import RPM, given

PACE = 10.0  # s of the clock in a second
STEP = 0.05  # s of the clock between two speeds
RATE = 1.0  # rpm/s by the clock
WARN_AHEAD = 80.0  # s
NAME = "fast"
ALARM = {
    "margin_warn_rpm": 0.0,
    "margin_error_rpm": 0.0,
    "time_warn": WARN_AHEAD,
    "time_error": 0.0,
    "eccentricity_warn": 0.0,
    "eccentricity_error": 0.0,
    "on_delay": 0.0,
}


class Player:
    """Plays a run-up by a clock of its own.

    Attributes
    ----------
    speed : float
        The speed [rpm].
    """

    def __init__(self, graph: Graph, speed: float) -> None:
        self.speed = speed
        self._clock = 1000.0  # s
        self._due = 0.0
        self.remote = Remote(graph, f"/{NAME}")
        self._publisher = graph.node.create_publisher(Clock, "/clock", 1)

    @property
    def warnings(self) -> list[Strings]:
        """The values of all warnings, with their levels."""
        found = (status for _, status in self.remote.warnings)
        return [{**strings(status), "level": str(status.level[0])} for status in found]

    @property
    def newest(self) -> Strings:
        """The values of the newest warning."""
        return self.warnings[-1] if self.remote.warnings else defaultdict(str)

    def play(self, condition, what: str, rate: float) -> None:
        """Publish speeds that rise at a rate [rpm/s] until a condition holds."""
        self.remote.graph.until(condition, what, between=lambda: self._catch_up(rate))

    def set_back(self, seconds: float) -> None:
        """Set the clock back [s]; the machine goes on."""
        self._clock -= seconds

    def _catch_up(self, rate: float) -> None:
        """Publish the next speed if it is time, and otherwise begin to wait for it."""
        if time.monotonic() < self._due:
            return
        self._due = time.monotonic() + STEP / PACE
        self._clock += STEP
        self.speed += rate * STEP
        stamp = round(self._clock * 1e9)
        self._publisher.publish(Clock(clock=Time(nanoseconds=stamp).to_msg()))
        self.remote.send(self.speed * RPM, stamp)


def test_the_time_to_the_jump_goes_by_the_clock(graph, start, tmp_path):
    alarm = (f"alarm.{key}:={value}" for key, value in ALARM.items())
    start(*given(tmp_path, "use_sim_time:=true", *alarm), "-r", f"__node:={NAME}")
    player = Player(graph, 3905.0)
    remote = player.remote
    graph.until(lambda: remote.curves, "a curve comes without a clock")
    remote.beats()
    assert remote.set({"frame_id": "shaft"}).successful
    assert remote.order("acknowledge") == (True, "there was nothing to acknowledge")
    assert not remote.eccentricity

    player.play(lambda: player.newest["time_to_jump_s"] == "inf", "the speed is known", rate=0.0)
    player.play(lambda: player.speed > 3912.0, "the speed rises steadily", RATE)
    before = len(player.warnings)
    player.play(lambda: player.speed > 3922.0, "the speed rises", RATE)
    player.set_back(2.0)
    player.play(lambda: player.newest["level"] == "1", "it warns", RATE)

    seen = [(float(one["time_to_jump_s"]), one) for one in player.warnings[before:]]
    known = [(seconds, one) for seconds, one in seen if not math.isnan(seconds)]
    assert len(known) > 1
    for seconds, one in known:
        assert seconds == pytest.approx(float(one["margin_rpm"]) / RATE, rel=0.02), one
    assert seen[-1][0] == pytest.approx(WARN_AHEAD, abs=2.0)
