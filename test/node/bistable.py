"""A predictor of a machine that is bistable at some speeds, and whose orbits have a closed form.

The journal whirls in circles about the centre, whose eccentricities one equation gives.
"""

import math
from functools import cache
from pathlib import Path

import yaml

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import Machine, machine_to_dict, override, override_all, read_machine

from ..hbm.test_circular_orbit import circular_orbits
from .graph import Graph, JointState, Numbers, Remote, Time
from .process import PAPER_ROTOR

RPM = math.pi / 30.0  # rad/s
UPPER_ONLY, BOTH, LOWER_ONLY = 3900.0 * RPM, 3998.0 * RPM, 4090.0 * RPM
CURVE = 300.0  # s until a curve must have come: its process gives way to all others
HEAVY, LIGHT = 5.039e-4, 2.0e-4  # kg m; with the light unbalance there is a single response
MACHINE = override_all(
    read_machine(PAPER_ROTOR),
    {
        "unbalance.disk_2.station": "disk_1",
        "unbalance.disk_2.magnitude": HEAVY,
        "dampers.damper_1.film.inertia": False,
    },
)


def given(folder: Path, *parameters: str) -> list[str]:
    """Return the arguments of a predictor of the machine, whose file goes into a folder."""
    file = folder / "machine.yaml"
    file.write_text(yaml.safe_dump(machine_to_dict(MACHINE)))
    values = (
        f"machine_file:={file}",
        "harmonics:=1",
        f"speed.min:={3850.0 * RPM}",
        f"speed.max:={4095.0 * RPM}",
        "curve.detached:=false",
        "stale_after:=60.0",
        "publish_rate:=1000.0",
        *parameters,
    )
    return [part for value in values for part in ("-p", value)]


def begin(start, graph: Graph, folder: Path, speed: float, *parameters: str) -> Remote:
    """Start a predictor of the machine, and wait until it predicts at a speed [rad/s]."""
    start(*given(folder, *parameters))
    remote = Remote(graph)
    remote.meet(speed)
    return remote


def changed(path: str, value: float) -> Machine:
    """Return the machine with another value."""
    return override(MACHINE, path, value)


@cache
def orbits(speed: float, machine: Machine = MACHINE) -> list[float]:
    """Eccentricities of the stable orbits at a speed [rad/s], the lower one first.

    Between two folds there are three, of which the middle one is unstable. What lies above 0.85
    belongs to the detached branch.
    """
    model = HarmonicBalance(machine, Harmonics(1)).model
    found = [e for e, _ in circular_orbits(machine, model, speed) if e < 0.85]
    return found[::2]


def settle_at(remote: Remote, speed: float) -> Numbers:
    """Predict at a speed once the response curve has come, and return the eccentricities."""
    values: dict[str, str] = {}

    def known() -> bool:
        values.update((pair.key, pair.value) for pair in remote.statuses["Jump"].values)
        return values["model_age_s"] == "0"

    remote.graph.until(known, "the response curve", lambda: remote.predict(speed), CURVE)
    return remote.predict(speed)[0]


class Topics:
    """One topic to the predictor and one from it, both of JointState, told apart by stamps."""

    def __init__(self, remote: Remote, into: str, out: str) -> None:
        self.remote = remote
        self.answers: dict[int, JointState] = {}
        node, name = remote.graph.node, remote.name
        self.publisher = node.create_publisher(JointState, f"{name}/{into}", 100)
        remote.graph.collect(JointState, f"{name}/{out}", self._keep)
        remote.graph.until(
            lambda: (
                self.publisher.get_subscription_count() and node.count_publishers(f"{name}/{out}")
            ),
            f"~/{into} is found",
        )

    def _keep(self, message: JointState) -> None:
        self.answers[Time.from_msg(message.header.stamp).nanoseconds] = message

    def send(self, stamp: int, **fields: object) -> None:
        """Publish a message with a stamp [ns]."""
        message = JointState(**fields)
        message.header.stamp = Time(nanoseconds=stamp).to_msg()
        self.publisher.publish(message)

    def ask(self, stamp: int, **fields: object) -> JointState:
        """Publish a message with a stamp [ns] and wait for that with the same stamp."""
        self.send(stamp, **fields)
        self.remote.graph.until(lambda: stamp in self.answers, f"answer with {stamp} ns")
        return self.answers[stamp]
