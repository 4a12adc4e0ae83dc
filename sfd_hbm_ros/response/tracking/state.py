"""What a predictor remembers over a restart: its response, and its alarm."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.tracking.following import NEAR, holds

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class State:
    """What a predictor has to remember.

    Attributes
    ----------
    speed : float
        Rotor speed [rad/s].
    harmonics : Harmonics
        Harmonics of the coefficients.
    coefficients : (rows, n) array
        The response [m].
    settled : bool
        Whether the history told on which branch the machine is.
    stamp : int
        When that was [ns].
    alarm : mapping
        State of the alarms, as JSON can hold it.
    loads : mapping of str to (2,) tuple of float
        Forces x, y that were given while the machine ran [N], by their stations.
    jumps : mapping
        The jumps that the machine made, as JSON can hold them.
    origin : float or None
        Where it is not settled: speed from which the response was followed [rad/s], if known.
    """

    speed: float
    harmonics: Harmonics
    coefficients: Array
    settled: bool
    stamp: int
    alarm: Mapping[str, Any]
    loads: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    jumps: Mapping[str, Any] = field(default_factory=dict)
    origin: float | None = None


class Restored(NamedTuple):
    """A response solved from a state.

    Attributes
    ----------
    solution : Solution
        What the machine has at the state's speed, or why it has nothing.
    same : bool
        Whether that is the stored response, and the machine can be on it.
    """

    solution: Solution
    same: bool


def restore(state: State, balance: HarmonicBalance) -> Restored:
    """Solve a machine from the stored coefficients at the stored speed."""
    if state.harmonics.revolutions > balance.harmonics.revolutions:
        balance = HarmonicBalance(balance.machine, state.harmonics, balance.model)
    x = balance.harmonics.change_from(state.harmonics, state.coefficients)
    if x.shape[1] != balance.clearances.size:
        return Restored(solve(balance, state.speed), False)
    solution = solve(balance, state.speed, solution_at(balance, state.speed, x))
    if not solution.converged:
        return Restored(solution, False)
    distance = float(np.abs((solution.coefficients - x) / balance.clearances).max())
    return Restored(solution, distance < NEAR and holds(balance, solution))


def to_plain(state: State) -> dict[str, Any]:
    """A state as JSON can hold it."""
    harmonics = state.harmonics
    return {
        "speed": state.speed,
        "harmonics": {
            "highest": harmonics.highest,
            "samples": harmonics.samples,
            "revolutions": harmonics.revolutions,
            "multiples": list(harmonics.multiples),
        },
        "coefficients": state.coefficients.tolist(),
        "settled": state.settled,
        "stamp": state.stamp,
        "alarm": dict(state.alarm),
        "loads": {station: list(force) for station, force in state.loads.items()},
        "jumps": dict(state.jumps),
        "origin": state.origin,
    }


def from_plain(content: Mapping[str, Any]) -> State:
    """The state that `to_plain` made plain; what older files lack may be missing.

    Raises
    ------
    AttributeError, KeyError, TypeError, ValueError
        If it is no state.
    """
    given = content["harmonics"]
    multiples = tuple(given["multiples"])
    numbers = given["highest"], given["samples"], given["revolutions"]
    if any(type(one) is not int for one in (*numbers, *multiples)):
        raise TypeError("harmonics must be whole numbers")
    harmonics = Harmonics(*numbers, multiples)
    coefficients = np.array(content["coefficients"], dtype=float)
    if coefficients.ndim != 2 or len(coefficients) != harmonics.rows:
        raise ValueError(f"coefficients must have {harmonics.rows} rows")
    return State(
        float(content["speed"]),
        harmonics,
        coefficients,
        bool(content["settled"]),
        int(content["stamp"]),
        content["alarm"],
        {station: (float(x), float(y)) for station, (x, y) in content.get("loads", {}).items()},
        content.get("jumps", {}),
        None if (origin := content.get("origin")) is None else float(origin),
    )
