"""What becomes of an input before it is used: its order, its age, its rate. Without ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from sfd_hbm_ros.machine import Machine

T = TypeVar("T")

FUTURE = 100_000_000
"""How far [ns] a stamp may lie ahead of the node's clock: clocks of two computers differ."""

RIM_SPEED = 2000.0
"""Speed of a rim [m/s] that no material withstands: its stress is the density times the square."""

BEYOND = 10.0
"""Multiple of the highest speed of the response curve up to which a speed is taken in any case."""

_NANO = 1e-9


class InputError(ValueError):
    """An input that cannot be used, in one sentence."""


@dataclass(frozen=True)
class Rim:
    """What of a rotor moves fastest.

    Attributes
    ----------
    name : str
        What it is of.
    radius : float
        Its radius [m]; a disk's is that of a solid one with its mass and inertia.
    """

    name: str
    radius: float

    @classmethod
    def of(cls, machine: Machine) -> Rim:
        """The rim of a machine."""
        shaft = (cls("the shaft", 0.5 * segment.outer_diameter) for segment in machine.shaft)
        disks = (
            cls(disk.name, math.sqrt(2.0 * disk.polar_inertia / disk.mass))
            for disk in machine.disks
        )
        return max((*shaft, *disks), key=lambda rim: rim.radius)

    def check(self, speed: float, highest: float) -> None:
        """Refuse a rotor speed that the machine cannot have.

        Parameters
        ----------
        speed : float
            The speed [rad/s].
        highest : float
            Highest speed of the response curve [rad/s].

        Raises
        ------
        InputError
            If the rim would reach `RIM_SPEED`, and the speed is `BEYOND` times the highest.
        """
        rim, limit = self.radius * speed, max(RIM_SPEED / self.radius, BEYOND * highest)
        if speed > limit:
            raise InputError(
                f"a speed must be below {limit:.3g} rad/s for this machine, not {speed:.6g}: the "
                f"rim of {self.name} would move at {rim:.3g} m/s"
            )


@dataclass
class Order:
    """The order of the stamps of one stream.

    Attributes
    ----------
    newest : int or None
        The newest stamp so far [ns].
    """

    newest: int | None = None

    def check(self, stamp: int, now: int) -> int:
        """Return the stamp of an input [ns], which for 0 is the time of its receipt.

        Where the clock was set back, be it the computer's or the simulated one, the newest stamp
        lies in the future and is forgotten.

        Parameters
        ----------
        stamp : int
            The stamp that the input carries [ns].
        now : int
            The time by the node's clock [ns].

        Raises
        ------
        InputError
            If the clock has not started, or the stamp is negative, lies in the future, or lies
            before that of an earlier input.
        """
        if now <= 0:
            raise InputError("use_sim_time is true and no time has come on /clock")
        if stamp < 0:
            raise InputError(f"its stamp must not be negative, as {stamp * _NANO:g} s is")
        stamp = stamp or now
        if stamp > now + FUTURE:
            raise InputError(f"its stamp lies {(stamp - now) * _NANO:.3g} s in the future")
        if self.newest is not None and self.newest > now + FUTURE:
            self.newest = None
        if self.newest is not None and stamp < self.newest:
            late = (self.newest - stamp) * _NANO
            raise InputError(f"its stamp lies {late:.3g} s before that of an earlier one")
        self.newest = stamp
        return stamp


@dataclass
class Drops:
    """What was dropped of what came from one source.

    Times are those of a steady clock [s], which neither jumps nor stands still.

    Attributes
    ----------
    source : str
        Where it came from.
    dropped : int
        How much of it was dropped.
    reason : str
        Why the last was dropped.
    """

    source: str
    dropped: int = 0
    reason: str = ""
    _dropped_at: float = -math.inf

    def drop(self, reason: str, now: float) -> None:
        """Count what cannot be used."""
        self.dropped += 1
        self.reason = reason
        self._dropped_at = now

    def since_drop(self, now: float) -> float:
        """Return the time since something was dropped [s], infinite if nothing was."""
        return now - self._dropped_at


@dataclass
class Feed(Drops, Generic[T]):
    """What came on one topic.

    Attributes
    ----------
    value : object or None
        The last value accepted.
    accepted : int
        How many were accepted.
    lag : float
        How far the stamp of the last lay behind the node's clock on arrival [s].
    """

    value: T | None = None
    accepted: int = 0
    lag: float = 0.0
    _accepted_at: float = -math.inf
    _orders: dict[str, Order] = field(default_factory=dict)

    def accept(self, value: T, stamp: int, clock: int, now: float, stream: str = "") -> int:
        """Take a value if its stamp allows it, and return its stamp.

        Parameters
        ----------
        value : object
            The value.
        stamp, clock : int
            Its stamp and the time by the node's clock [ns], see `Order.check`.
        now : float
            Time by the steady clock [s].
        stream : str
            Within which of the topic's streams the stamps have an order.

        Raises
        ------
        InputError
            If the stamp is not allowed.
        """
        stamp = self._orders.setdefault(stream, Order()).check(stamp, clock)
        self.value = value
        self.accepted += 1
        self.lag = (clock - stamp) * _NANO
        self._accepted_at = now
        return stamp

    def forget(self) -> None:
        """Wait for a value as at the start; the counts go on."""
        self.value = None
        self._accepted_at = -math.inf
        self._orders.clear()

    def age(self, now: float) -> float:
        """Return the time since a value was accepted [s], infinite if there is none."""
        return now - self._accepted_at


@dataclass
class Pending(Generic[T]):
    """The newest request, granted at a limited rate; an older one is replaced, never the newest.

    Attributes
    ----------
    rate : float
        Requests granted a second, at most [Hz].
    """

    rate: float
    _request: T | None = None
    _granted_at: float = -math.inf

    @property
    def waits(self) -> bool:
        """Whether there is a request."""
        return self._request is not None

    def put(self, request: T) -> None:
        """Replace the request."""
        self._request = request

    def wait(self, now: float) -> float:
        """Return how long a request has to wait from now on [s]."""
        return max(0.0, self._granted_at + 1.0 / self.rate - now)

    def take(self, now: float) -> T | None:
        """Grant and remove the request, if there is one."""
        request, self._request = self._request, None
        if request is not None:
            self._granted_at = now
        return request
