"""What the node says about itself: one status a subject, in plain sentences. Without ROS."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from sfd_hbm_ros.node.inputs import Drops, Feed
from sfd_hbm_ros.node.prediction import Model, Prediction
from sfd_hbm_ros.response.warning.settings import Level

RECENT = 5.0
"""For how long [s] a dropped input or a caught exception keeps its warning."""

COARSE = 1e-3
"""Truncation error [of the clearance] that is warned of: it shows in the published numbers."""


@dataclass(frozen=True)
class Status:
    """How one subject fares.

    Attributes
    ----------
    subject : str
        What it is about.
    level : Level
        How it fares.
    message : str
        The same in a sentence.
    values : mapping of str to str
        What there is to know beyond that, units in the keys.
    """

    subject: str
    level: Level
    message: str
    values: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Levels:
    """The levels last published, by subject."""

    published: dict[str, Level] = field(default_factory=dict)

    def worsened(self, statuses: Iterable[Status]) -> bool:
        """Return whether a subject fares worse than was published."""
        return any(
            status.level > self.published.get(status.subject, Level.OK) for status in statuses
        )

    def publish(self, statuses: Iterable[Status]) -> None:
        """Remember what is being published."""
        self.published = {status.subject: status.level for status in statuses}


def model_status(state: str, problem: str, file: str, model: Model | None) -> Status:
    """Return how the machine's model fares; a problem is why there is none."""
    values = {"state": state, "machine_file": file}
    if model is not None:
        values["machine"] = model.machine.name
        values["dampers"] = ", ".join(damper.name for damper in model.machine.dampers)
        values["harmonics"] = str(model.harmonics.highest)
    level = Level.ERROR if problem else Level.OK
    return Status("Model", level, problem or state, values)


def solver_status(prediction: Prediction | None, predictions: int, failures: int) -> Status:
    """Return how the last prediction fared, of so many and so many failures among them."""
    values = {"predictions": str(predictions), "failures": str(failures)}
    if prediction is None:
        return Status("Solver", Level.OK, "nothing has been predicted yet", values)
    values |= {
        "speed [rad/s]": f"{prediction.speed:.6g}",
        "residual [of the load]": f"{prediction.residual:.3g}",
        "iterations": str(prediction.iterations),
        "time [ms]": f"{1e3 * prediction.seconds:.3g}",
        "truncation error [of the clearance]": f"{prediction.truncation:.2g}",
    }
    level, message = Level.ERROR if prediction.failed else Level.OK, prediction.message
    if prediction.truncation > COARSE:
        level = max(level, Level.WARN)
        message += (
            f"; more harmonics would move the orbit by {prediction.truncation:.1g} of the "
            "clearance: raise the parameter harmonics"
        )
    return Status("Solver", level, message, values)


def inputs_status(
    active: bool, speed: Feed[Any], others: Iterable[Drops], stale_after: float, now: float
) -> Status:
    """Return how the inputs fare.

    Parameters
    ----------
    active : bool
        Whether the node uses them.
    speed : Feed
        The input without which there is no prediction.
    others : iterable of Drops
        All other inputs.
    stale_after : float
        Age from which the speed is stale [s]; one whose stamp lags as much is warned of.
    now : float
        Time by the inputs' steady clock [s].
    """
    sources = [speed, *others]
    level, message = _speed_level(active, speed, stale_after, now)
    last = min(sources, key=lambda source: source.since_drop(now))
    if last.since_drop(now) < RECENT:
        level = max(level, Level.WARN)
        message += f"; dropped from {last.source}: {last.reason}"
    values = {key: value for source in sources for key, value in _known(source, now)}
    return Status("Inputs", level, message, values)


def _speed_level(
    active: bool, speed: Feed[Any], stale_after: float, now: float
) -> tuple[Level, str]:
    """Return how the speed fares, and the same in words."""
    age = speed.age(now)
    if not active:
        return Level.OK, "not used, as the node is not active"
    if math.isinf(age):
        return Level.WARN, f"waiting for the first message on {speed.source}"
    if age > stale_after:
        stale = f"{speed.source} is stale, its last message came {age:.1f} s ago"
        return Level.ERROR, f"{stale}: nothing is predicted"
    if speed.lag > stale_after:
        late = f"{speed.source} arrives late, its last stamp was {speed.lag:.1f} s old"
        return Level.WARN, f"{late}: the predictions are of that time"
    return Level.OK, f"{speed.source} arrives"


def _known(source: Drops, now: float) -> Iterator[tuple[str, str]]:
    """Yield what there is to know about one input."""
    if isinstance(source, Feed):
        yield f"{source.source}: accepted", str(source.accepted)
        yield f"{source.source}: age [s]", f"{source.age(now):.3g}"
    yield f"{source.source}: dropped", str(source.dropped)
    if source.reason:
        yield f"{source.source}: last dropped", source.reason
