"""When a machine on its way jumps, by the time integration."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from benchmarks.warned_run import Run
from sfd_hbm_ros.hbm import Solution
from sfd_hbm_ros.response.curves.journey import travel
from sfd_hbm_ros.response.curves.place import Place, response_on
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.integrator import Integrator, State
from sfd_hbm_ros.response.integration.observed import LEAST, SIDE, ObservedJump, observed_jumps
from sfd_hbm_ros.response.integration.options import DEFAULTS, IntegrationOptions
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import Transient, run
from sfd_hbm_ros.rotor import is_axisymmetric

CIRCLES = IntegrationOptions(steps=1)  # enough for them, and halved where it is not
HELD = 200  # revolutions at a speed after which a response has settled


def jump_in_time(case: Run) -> float:
    """When the machine first jumps [s]; infinite if it passes the end without.

    The integration begins with a periodic response and goes on until the machine has jumped. A
    steep change far from where the curve shows a jump is one only if it is not undone on the way
    back; of those near there the greatest is, and others belong to the flank that leads to it. A
    machine that leaves its response too gradually for any of them, as beside a fold that a ramp
    passes fast, has jumped where the curve shows it if that is not undone either.

    Raises
    ------
    NoSolutionError
        If there is no solution to start from, or a journal closes on its clearance.
    """
    integrator, whole, state = _beginning(case)
    marks = [(whole.start, state)]
    reversible, at_fold = set[float](), list[ObservedJump]()
    for way in _ways(integrator, whole, state):
        marks.append((_end(way.ramp), way.state))
        aside = 2.0 * SIDE * marks[-1][0]
        seen = [jump for jump in observed_jumps(way) if abs(marks[-1][0] - jump.speed) >= aside]
        until_fold = {jump: case.time(case.fold) - case.time(jump.speed) for jump in seen}
        at_fold = [jump for jump in seen if until_fold[jump] <= aside / abs(whole.acceleration)]
        for jump in seen:
            if jump in at_fold or jump.speed in reversible:
                continue
            if _stays(integrator, whole.acceleration, marks, jump.speed):
                return case.time(jump.speed)
            reversible.add(jump.speed)
        if any(until_fold[jump] <= 0.0 for jump in at_fold):
            break
    if at_fold:
        return case.time(max(at_fold, key=_change).speed)
    passed = np.isfinite(case.fold) and _stays(integrator, whole.acceleration, marks, case.fold)
    return case.time(case.fold) if passed else np.inf


def _beginning(case: Run) -> tuple[Integrator, Ramp, State]:
    """What integrates a run, the run from where it was last periodic on, and its state there."""
    origin, end = _last_periodic(case), _end(case.ramp)
    solution = response_on(origin)
    if not isinstance(solution, Solution):
        raise NoSolutionError("no solution to start from")
    balance = case.curve.balance
    options = CIRCLES if is_axisymmetric(balance.model) else DEFAULTS
    integrator = Integrator(balance, max(origin.value, end), options)
    whole = Ramp.between(origin.value, end, abs(case.ramp.acceleration))
    return integrator, whole, integrator.start(solution)


def _last_periodic(case: Run) -> Place:
    """The last place on the way to the start at which the machine is periodic."""
    for speed in np.linspace(case.ramp.start, case.first.value, 50).tolist():
        place = travel(case.curve, case.first, speed).place
        if place is not None and place.stable_orbit:
            return place
    return case.first


def _ways(integrator: Integrator, whole: Ramp, state: State) -> Iterator[Transient]:
    """The run up to one place after another, as it is integrated from its start."""
    parts, done = list[Transient](), 0
    while done < whole.revolutions:
        start = float(whole.speed(np.array([float(done)]))[0])
        part = round(SIDE * start**2 / (2.0 * np.pi * abs(whole.acceleration))) + 1
        ramp = Ramp(start, whole.acceleration, min(part, whole.revolutions - done))
        parts.append(run(integrator, ramp, state))
        state, done = parts[-1].state, done + ramp.revolutions
        yield _joined(replace(whole, revolutions=done), parts)


def _joined(ramp: Ramp, parts: Sequence[Transient]) -> Transient:
    """The run of which these are the parts."""
    greatest, mean = (
        {name: np.concatenate([one[name] for one in values]) for name in values[0]}
        for values in (
            [part.eccentricity_max for part in parts],
            [part.eccentricity_mean for part in parts],
        )
    )
    return replace(parts[-1], ramp=ramp, eccentricity_max=greatest, eccentricity_mean=mean)


def _stays(
    integrator: Integrator,
    acceleration: float,
    marks: Sequence[tuple[float, State]],
    jump: float,
) -> bool:
    """Whether the machine responds otherwise when it has gone back to before a jump.

    Parameters
    ----------
    integrator : Integrator
        The machine.
    acceleration : float
        That of the run [rad/s2].
    marks : sequence of (float, State)
        Speeds of the run [rad/s] and its state there, the last beyond the jump.
    jump : float
        Speed of the jump [rad/s].
    """
    sign = np.sign(acceleration)
    before = jump * (1.0 - sign * SIDE)
    passed = [mark for mark in marks if sign * (before - mark[0]) >= 0.0]
    speed, state = passed[-1] if passed else marks[0]
    end, beyond = marks[-1]
    back = run(integrator, Ramp.between(end, speed, abs(acceleration)), beyond).state
    held = Ramp(speed, 0.0, HELD)
    there, again = (run(integrator, held, one).worst_eccentricity[-1] for one in (state, back))
    return bool(abs(there - again) >= LEAST)


def _change(jump: ObservedJump) -> float:
    """How far the eccentricity jumps."""
    return abs(jump.eccentricity_to - jump.eccentricity_from)


def _end(ramp: Ramp) -> float:
    """The last speed of a ramp [rad/s]."""
    return float(ramp.speed(np.array([float(ramp.revolutions)]))[0])
