"""A predictor of a bistable machine that is killed at bad moments and started again."""

import math
import random
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from sfd_hbm_ros.response.tracking.state_file import load_state

from .bistable import BOTH, LOWER_ONLY, MACHINE, RPM, UPPER_ONLY, given, orbits
from .graph import Graph, Remote, Strings, strings
from .process import NodeProcess

WARN = b"\x01"
BRANCHES = ("lower", "upper")
COMES_FROM = {"lower": LOWER_ONLY, "upper": UPPER_ONLY}
# The machine jumps at 3979 and 4017 rpm. Close to that the alarm is raised, and not elsewhere.
NEAR_JUMP = {"lower": 3985.0 * RPM, "upper": 4008.0 * RPM}
ELSEWHERE = 5.0 * RPM  # within which of the middle the machine is later
ALARM = {
    "margin_warn_rpm": 12.0,
    "margin_error_rpm": 0.0,
    "time_warn": 0.0,
    "time_error": 0.0,
    "eccentricity_warn": 0.0,
    "eccentricity_error": 0.0,
    "latch": "true",
    "off_delay": 0.0,
}
PERIOD = 20_000_000  # ns between two speeds
PATIENCE = 50.0  # s within which branch and alarm must be known
CLOSE = 1e-6  # to the closed form, of the clearance


class Victim:
    """A predictor on a branch, with its alarm latched and acknowledged.

    Parameters
    ----------
    graph : Graph
        The tests' node.
    start : callable
        Starts a predictor with ROS arguments.
    folder : Path
        Where its files go.
    branch : str
        The branch, lower or upper.
    seed : int
        Of the moments at which it is killed, and of the speeds.

    Attributes
    ----------
    process : NodeProcess
        The predictor as it lives now.
    half_written : int
        How many times it was killed in the midst of writing its state file.
    """

    def __init__(
        self,
        graph: Graph,
        start: Callable[..., NodeProcess],
        folder: Path,
        branch: str,
        seed: int,
    ) -> None:
        self.half_written = 0
        self._file = folder / "state.json"
        self._part = folder / "state.json.part"
        name = f"killed_{branch}"
        self._revived = 0  # stamp [ns] from which on predictions count
        alarm = (f"alarm.{key}:={value}" for key, value in ALARM.items())
        arguments = *given(folder, f"state_file:={self._file}", *alarm), "-r", f"__node:={name}"
        self._start: Callable[[], NodeProcess] = lambda: start(*arguments)
        self._branch = branch
        self._random = random.Random(seed)
        self._graph = graph
        self._remote = Remote(graph, f"/{name}")
        self._sent = 0
        self.process = self._start()
        self._remote.meet(COMES_FROM[branch])
        self._speed = COMES_FROM[branch]
        self._expected = self._latched()

    def kill_running(self) -> None:
        """Kill it at any moment."""
        self._play(self._random.uniform(0.0, 1.0))
        self._kill()

    def kill_writing(self) -> None:
        """Kill it as it writes its state file, which it does once a second."""
        end = time.monotonic() + PATIENCE
        while not self._part.exists() and time.monotonic() < end:
            self._send()
        self._kill()

    def kill_starting(self) -> None:
        """Kill it, and once more at any moment of its start."""
        self._kill()
        self.process = self._start()
        self._play(self._random.uniform(0.0, 2.0))
        self._kill()

    def revive(self) -> tuple[float, float]:
        """Start it, and return after what times it is active and its first valid prediction here.

        Meanwhile the machine has gone on to another speed. Between the two times [s], DDS lets
        the node and its neighbours know of one another.
        """
        self._speed = BOTH + self._random.uniform(-ELSEWHERE, ELSEWHERE)
        self._revived = self._remote.now()
        self._remote.warnings.clear()
        begin = time.monotonic()
        self.process = self._start()
        active = math.inf

        def predicted() -> bool:
            nonlocal active
            assert self.process.running, self.process.said()
            if active == math.inf and "]: active\n" in self.process.said():
                active = time.monotonic() - begin
            return any(value == value for value in self._predicted())

        self._graph.until(predicted, "a prediction", between=self._send)
        here = time.monotonic() - begin
        return min(active, here), here

    def lost(self) -> str:
        """Return what has not come back in words, empty where all is soon known as before."""
        end = time.monotonic() + PATIENCE

        def settled() -> bool:
            return self._known() == self._expected or time.monotonic() > end

        self._graph.until(settled, "an answer", between=self._send)
        right = orbits(self._speed)[BRANCHES.index(self._branch)]
        wrong = [value for value in self._predicted() if not abs(value - right) < CLOSE]
        if wrong:
            return f"{len(wrong)} predictions off the branch: {wrong[0]:.6f}, not {right:.6f}"
        known = self._known()
        return "" if known == self._expected else f"known is {known}, not {self._expected}"

    def _latched(self) -> Strings:
        """Latch and acknowledge the alarm, and return what is known from then on."""
        self._graph.until(lambda: self._remote.curves, "a curve", between=self._send)
        self._remote.until_warning(WARN, "to be acknowledged", NEAR_JUMP[self._branch])
        assert self._remote.order("acknowledge") == (True, "acknowledged")
        self._speed = BOTH
        expected = {
            "branch": self._branch,
            "alarm": "returned to normal, acknowledged, not reset",
            "occurrences": "1",
            "level": "1",
        }
        self._graph.until(lambda: self._known() == expected, "all is set", between=self._send)
        self._graph.until(self._stored, "all is stored", between=self._send)
        return expected

    def _stored(self) -> bool:
        """Return whether the acknowledged alarm is in the state file, which takes a write."""
        state = load_state(self._file, MACHINE)
        warning = state.alarm["warn"] if state else {"acknowledged": False}
        return warning["acknowledged"] and not warning["active"]

    def _known(self) -> Strings:
        """What the newest warning tells of branch and alarm."""
        if not self._remote.warnings:
            return {}
        status = self._remote.warnings[-1][1]
        values = strings(status)
        known = {key: values[key] for key in ("branch", "alarm", "occurrences")}
        return {**known, "level": str(status.level[0])}

    def _predicted(self) -> Iterator[float]:
        """Yield the eccentricities predicted since it came back."""
        for stamp, message in self._remote.eccentricity.items():
            if stamp >= self._revived:
                yield message.position[message.name.index("damper_1/max")]

    def _kill(self) -> None:
        self.process.stop(signal.SIGKILL)
        self.half_written += self._part.exists()

    def _play(self, seconds: float) -> None:
        """Publish the speed for a time [s]."""
        end = time.monotonic() + seconds
        self._graph.until(lambda: time.monotonic() > end, "the time", between=self._send)

    def _send(self) -> None:
        """Publish the speed if it is time."""
        now = self._remote.now()
        if now >= self._sent + PERIOD:
            self._remote.send(self._speed, now)
            self._sent = now
