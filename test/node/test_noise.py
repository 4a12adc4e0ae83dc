"""Loads and oil temperatures that tremble while the machine runs up to a jump, through the node.

The paper's rotor with 503.9 g mm on disk 2 jumps at about 4160 rpm on the way up, even where it
bears a load of 200 N.
"""

from dataclasses import replace

import numpy as np
import pytest

from .graph import Remote, Time  # first, as it skips the file without ROS

# isort: split
from sensor_msgs.msg import Temperature

from sfd_hbm_ros.machine import Load as OwnLoad
from sfd_hbm_ros.machine import read_machine, write_machine

from .bistable import CURVE, settle_at
from .process import PAPER_ROTOR
from .test_watch import GIVEN, OK, RPM, WARN, jump, run

FORCE = 200.0  # N
REST = 390.0  # rad/s
CELSIUS = 40.0


@pytest.fixture(scope="module")
def running(graph, start, tmp_path_factory) -> Remote:
    machine = replace(read_machine(PAPER_ROTOR), loads=(OwnLoad("disk_3", (0.0, -FORCE)),))
    file = tmp_path_factory.mktemp("machine") / "machine.yaml"
    write_machine(machine, file)
    values = {**GIVEN, "machine_file": file, "speed.min": 385.0, "speed.max": 450.0}
    values |= {"oil.grade": 32, "harmonics": 1}
    start(*(part for name, value in values.items() for part in ("-p", f"{name}:={value}")))
    remote = Remote(graph)
    remote.meet(REST)
    return remote


class Disturbance:
    """Sends a value that trembles, ten times a second."""

    def __init__(self, remote: Remote, mean: float, noise: float) -> None:
        self.remote = remote
        self.mean, self.noise = mean, noise
        self._rng = np.random.default_rng(1)
        graph, topic = remote.graph, f"{remote.name}/oil_temperature"
        self._oil = graph.node.create_publisher(Temperature, topic, 10)
        graph.until(self._oil.get_subscription_count, "~/oil_temperature is found")

    def begin(self) -> None:
        self._timer = self.remote.graph.node.create_timer(0.1, self._send)

    def end(self) -> None:
        self.remote.graph.node.destroy_timer(self._timer)
        self.remote.graph.node.destroy_publisher(self._oil)

    def _send(self) -> None:
        self.send(self.mean + self.noise * self._rng.normal())

    def send(self, value: float) -> None:
        raise NotImplementedError


class Force(Disturbance):
    """The load of the machine, or another one [N]."""

    def send(self, value: float) -> None:
        station = "disk_3" if self.mean else "disk_1"
        self.remote.push(station, (0.0, -value), self.remote.now())


class Oil(Disturbance):
    """The oil's temperature [deg C]."""

    def send(self, value: float) -> None:
        message = Temperature(temperature=value)
        message.header.stamp = Time(nanoseconds=self.remote.now()).to_msg()
        self._oil.publish(message)


@pytest.mark.parametrize(
    ("kind", "mean", "noise"),
    [
        (Force, FORCE, 0.0),
        (Force, FORCE, 0.05 * FORCE),
        (Force, 0.0, 0.1),
        (Oil, CELSIUS, 0.0),
        (Oil, CELSIUS, 0.5),
    ],
    ids=["load", "noisy load", "noise without a load", "oil", "fluttering oil"],
)
def test_a_jump_is_warned_of_while_the_input_trembles(running, kind, mean, noise):
    first, last = 4010.0, 4190.0
    disturbance = kind(running, mean, noise)
    disturbance.send(mean)
    settle_at(running, REST)
    disturbance.begin()
    try:
        # what the speed did before is forgotten, lest its step count as an acceleration
        assert running.change_state("deactivate", "activate") == [True, True]
        running.until_warning(OK, "the present speed", first * RPM)
        running.warnings.clear()
        found = run(running, first, last, 9.0, 0.05, 0.2)
    finally:
        disturbance.end()
    came, speed = jump(found)
    assert speed > 4140.0
    before = [(stamp, status) for stamp, status in running.warnings if stamp < came]
    assert not [status.message for _, status in before if "not known" in status.message]
    warned = next(came - stamp for stamp, status in before if status.level == WARN) * 1e-9
    assert 1.0 < warned < 4.0  # 3 s are configured; the computer may be busy


def test_a_first_load_of_nothing_leaves_the_curve_as_it_is(running):
    settle_at(running, REST)
    running.push("disk_2", (0.0, 0.0), running.now())
    running.warnings.clear()
    for _ in range(3):
        values = running.until_warning(OK, "the present speed", REST)
        assert values["model_age_s"] == "0"


def test_a_load_that_changes_for_good_brings_another_curve(running):
    settle_at(running, REST)
    number = len(running.curves)
    running.push("disk_3", (0.0, 2.0 * FORCE), running.now())
    running.until_warning(OK, "of no use any more", REST)
    running.graph.until(lambda: len(running.curves) > number, "a new curve comes", limit=CURVE)
    running.until_warning(OK, "the present speed", REST)
