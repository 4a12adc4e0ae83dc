"""How well jumps are warned of: random run-ups and coast-downs of random machines.

The jump is taken from the time integration, the warning from the response curve and from noisy
speeds. A run counts as warned where the warning stood for the configured time before the jump
came; chatter is a level that was entered more than once. Where the curve shows no jump ahead the
whole range is run through, and any warning is false.

    python3 -m benchmarks.warned --runs 200
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution
from sfd_hbm_ros.machine import Machine, override_all
from sfd_hbm_ros.response.curves.curve import NoSolutionError, ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.journey import travel
from sfd_hbm_ros.response.curves.jumps import solutions_at
from sfd_hbm_ros.response.curves.place import Place, places_at
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.observed import observed_jumps
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import run
from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.jump_map import JumpMap, jump_map
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level
from sfd_hbm_ros.rotor import critical_speeds, hold_journals
from test.hbm.machines import random_machine

Array = NDArray[np.float64]

AHEAD = 2.0  # s by which a jump is to be warned of
APPROACH = 6.0  # s of a run before the jump that the curve shows
BEYOND = 0.02  # part of the speed by which a run goes on beyond it
INTEGRATED = 1.5  # s of the approach that are integrated, the rest being slow
RATE, NOISE = 50.0, 0.05  # of the speeds: Hz, rad/s
SETTINGS = AlarmSettings(
    margin_warn_rpm=0.0,
    margin_error_rpm=0.0,
    time_warn=AHEAD + 0.5,  # what the on-delay and the noise take is to be on top
    time_error=0.0,
    eccentricity_warn=0.0,
    eccentricity_error=0.0,
    on_delay=0.1,
    off_delay=1.0,
)


@dataclass(frozen=True)
class Case:
    """A machine on its way.

    Attributes
    ----------
    curve : ResponseCurve
        Its response.
    ahead : JumpMap
        Its jumps.
    place : Place
        Where it is at first.
    ramp : Ramp
        Its speed.
    jumps : bool
        Whether the curve shows a jump on the way.
    """

    curve: ResponseCurve
    ahead: JumpMap
    place: Place
    ramp: Ramp
    jumps: bool


def random_case(rng: np.random.Generator) -> Case:
    """A random machine near the critical speed of its shaft with the journal held."""
    machine = heavier(random_machine(int(rng.integers(10**6)), elements=6), rng.uniform(0.5, 2.5))
    balance = HarmonicBalance(machine, Harmonics(1))
    critical = critical_speeds(hold_journals(balance.model))[0].speed
    curve = response_curve(balance, 0.85 * critical, 1.1 * critical)
    ahead = jump_map(curve)
    sign = float(rng.choice([-1.0, 1.0]))
    begin, end = (0.851 * critical, 1.099 * critical)[:: int(sign)]
    place = places_at(curve.branches, begin)[0]
    jump = ahead.outlook(place, sign).next
    if not np.isfinite(jump.speed):
        return Case(curve, ahead, place, Ramp.between(begin, end, 0.02 * critical), False)
    rate = critical * rng.uniform(0.002, 0.006)
    start = jump.speed - sign * min(APPROACH * rate, abs(jump.speed - begin))
    end = jump.speed * (1.0 + sign * BEYOND)
    there = travel(curve, place, start).place
    assert there is not None
    return Case(curve, ahead, there, Ramp.between(start, end, rate), True)


def heavier(machine: Machine, factor: float) -> Machine:
    """A machine with a multiple of its unbalance."""
    changes = {
        f"unbalance.{one.station}.magnitude": factor * one.magnitude for one in machine.unbalance
    }
    return override_all(machine, changes)


def time_of_jump(case: Case) -> float:
    """When the machine jumps by the time integration [s]; NaN if it does not."""
    balance, whole = case.curve.balance, case.ramp
    rate, end = whole.acceleration, float(whole.speed(np.array([float(whole.revolutions)]))[0])
    jump = case.ahead.outlook(case.place, rate).next.speed
    start = max(whole.start, jump - INTEGRATED * rate, key=lambda speed: rate * speed)
    place = travel(case.curve, case.place, start).place
    assert place is not None
    [solution] = [one for i, one in solutions_at(place.branch, start) if i == place.index]
    assert isinstance(solution, Solution)  # not a quasi-periodic response
    integrator = Integrator(balance, max(start, end))
    ramp = Ramp.between(start, end, abs(rate))
    found = observed_jumps(run(integrator, ramp, integrator.start(solution)))
    return (found[0].speed - whole.start) / rate if found else np.nan


def warnings(case: Case, rng: np.random.Generator) -> list[float]:
    """When the level was entered [s], as noisy speeds came in up to the jump or the end."""
    estimator, alarm, place = AccelerationEstimator(), JumpAlarm(SETTINGS), case.place
    found, before = [], Level.OK
    duration = float(case.ramp.time(np.array([float(case.ramp.revolutions)]))[0])
    for time in np.arange(0.0, duration, 1.0 / RATE).tolist():
        speed = case.ramp.start + case.ramp.acceleration * time + rng.normal(0.0, NOISE)
        journey = travel(case.curve, place, speed)
        if journey.place is None or journey.jumps:
            break
        place = journey.place
        estimator.add(round(time * 1e9), speed)
        outlook = case.ahead.outlook(place, estimator.acceleration)
        alarm.update(outlook, place.eccentricity, time)
        level = alarm.level(time)
        if level > before:
            found.append(time)
        before = level
    return found


def judge(rng: np.random.Generator) -> str:
    """What became of one run."""
    try:
        case = random_case(rng)
        raised = warnings(case, rng)
        if not case.jumps:
            return "false warning" if raised else "rightly silent"
        jump = time_of_jump(case)
    except NoSolutionError:
        return "not computed"
    if np.isnan(jump):
        return "no jump in time"
    if len(raised) > 1:
        return "chatter"
    return "warned" if raised and jump - raised[0] >= AHEAD else "missed"


def main() -> None:
    """Run and print the score."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=200, help="runs that end in a jump")
    parser.add_argument("--seed", type=int, default=1, help="of the random machines")
    arguments = parser.parse_args()
    rng, counts = np.random.default_rng(arguments.seed), Counter[str]()
    while (jumped := sum(counts[key] for key in ("warned", "missed", "chatter"))) < arguments.runs:
        print(f"\r{jumped} of {arguments.runs} jumps", end="", file=sys.stderr, flush=True)
        counts[judge(rng)] += 1
    print(file=sys.stderr)
    for what, count in counts.most_common():
        print(f"{count:5} {what}")
    print(f"{100.0 * counts['warned'] / jumped:.1f} % warned at least {AHEAD:g} s ahead")


if __name__ == "__main__":
    main()
