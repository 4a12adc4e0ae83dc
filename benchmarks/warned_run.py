"""A random machine on its way through the speeds about its critical one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.machine import Machine, override_all
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.journey import legs, travel
from sfd_hbm_ros.response.curves.place import Place, places_at
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.observed import FEWEST, SIDE
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.rotor import critical_speeds, hold_journals
from test.hbm.machines import random_machine

RANGE = 0.85, 1.1  # of the critical speed of the shaft with its journals held
INSET = 0.001  # of the critical speed, by which a run keeps from the ends of the range
RATES = 0.002, 0.006  # of the critical speed, 1/s
APPROACH = 4.0  # s of a run before the jump that the curve shows
SIDE_REVOLUTIONS = FEWEST + 2  # on each side of a jump in the fastest run
BEYOND = 0.06  # part of the speed by which a run goes on after it, if no jump comes before
LOADED = 0.1  # part of the machines that have gravity, a side load and uneven bearings
HARMONICS = 5  # of these; the others move in circles


@dataclass(frozen=True, eq=False)
class Run:
    """A machine on its way.

    Attributes
    ----------
    curve : ResponseCurve
        Its response.
    first : Place
        Where it enters the range; periodic and stable.
    place : Place
        Where it is at the start.
    ramp : Ramp
        Its speed.
    fold : float
        Speed of the first jump that the curve shows on the way [rad/s]; for none, where it would
        take an infinite time to come to.
    change : float
        Change of the greatest eccentricity there; NaN where it is not known.
    """

    curve: ResponseCurve
    first: Place
    place: Place
    ramp: Ramp
    fold: float
    change: float = np.nan

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.ramp.time(np.array([float(self.ramp.revolutions)]))[0])

    def time(self, speed: float) -> float:
        """When it has a speed [s]."""
        return (speed - self.ramp.start) / self.ramp.acceleration


def random_run(rng: np.random.Generator, approach: float = APPROACH) -> Run:
    """A run-up or a coast-down that begins with any stable periodic response of a machine.

    Parameters
    ----------
    rng : Generator
        What makes it random.
    approach : float
        Time before the jump that the curve shows at which the run starts [s].

    Raises
    ------
    NoSolutionError
        If the machine has no response curve, or there is no such response.
    """
    balance = _random_balance(rng)
    critical = critical_speeds(hold_journals(balance.model))[0].speed
    lowest, highest = (part * critical for part in RANGE)
    curve = response_curve(balance, lowest, highest)
    sign = float(rng.choice([-1.0, 1.0]))
    begin, end = (lowest + INSET * critical, highest - INSET * critical)[:: int(sign)]
    stable = [place for place in places_at(curve.branches, begin) if place.stable_orbit]
    if not stable:
        raise NoSolutionError("no stable periodic response to begin with")
    first = stable[int(rng.integers(len(stable)))]
    rate = critical * rng.uniform(*RATES)
    # to the very end of the range: a fold beside the end of a run is rightly warned of
    leg = next(legs(curve, first, highest if sign > 0.0 else lowest))
    if leg.arrived:
        fastest = SIDE * lowest**2 / (2.0 * np.pi * SIDE_REVOLUTIONS)  # lest a jump stay unseen
        return Run(curve, first, first, Ramp.between(begin, end, fastest), sign * np.inf)
    fold = leg.end.value
    start = fold - sign * min(approach * rate, abs(fold - begin))
    ramp = Ramp.between(start, fold * (1.0 + sign * BEYOND), rate)
    place = travel(curve, first, start).place
    assert place is not None  # as it lies before the first jump
    change = leg.landing.eccentricity - leg.end.eccentricity if leg.landing else np.nan
    return Run(curve, first, place, ramp, fold, change)


def _random_balance(rng: np.random.Generator) -> HarmonicBalance:
    """The equations of a random machine with much unbalance or little."""
    loaded = bool(rng.random() < LOADED)
    seed = int(rng.integers(10**6))
    machine = random_machine(seed, elements=6, anisotropic=loaded, gravity=loaded)
    machine = _heavier(machine, rng.uniform(0.5, 2.5))
    return HarmonicBalance(machine, Harmonics(HARMONICS if loaded else 1))


def _heavier(machine: Machine, factor: float) -> Machine:
    """A machine with a multiple of its unbalance."""
    changes = {
        f"unbalance.{one.station}.magnitude": factor * one.magnitude for one in machine.unbalance
    }
    return override_all(machine, changes)
