"""The messages of the nodes, built and read in this file and its neighbours.

JointState is used because it is the stamped, named list of doubles that PlotJuggler, Foxglove and
rosbag2 read without a package of our own; a typed interface package can replace it here.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import WrenchStamped
from rclpy.time import Time
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Header

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.response.tracking.measured import named_harmonics

Journals = Mapping[str, JournalMotion]
Named = Iterator[tuple[str, float]]

MOST_NAMES = 10_000
"""Named numbers that a message may hold: those of any machine, and soon read."""

_SECOND = 1_000_000_000
_ABSOLUTE_ZERO = -273.15  # deg C


def read_stamp(header: Header) -> int:
    """Return the stamp of a message [ns], negative ones too.

    Raises
    ------
    InputError
        If the nanoseconds are no part of a second.
    """
    stamp = header.stamp
    if stamp.nanosec >= _SECOND:
        raise InputError(f"stamp.nanosec must be below {_SECOND}, not {stamp.nanosec}")
    return int(stamp.sec * _SECOND + stamp.nanosec)


def read_speed(message: JointState) -> float:
    """Return the rotor speed of a message [rad/s], zero at rest.

    Raises
    ------
    InputError
        If there is not one velocity, or it is negative or not finite.
    """
    if len(message.velocity) != 1:
        raise InputError(
            f"velocity must hold one number, the rotor speed [rad/s], not {len(message.velocity)}"
        )
    speed = float(message.velocity[0])
    if not 0.0 <= speed < math.inf:
        raise InputError(f"velocity[0] must be a finite number [rad/s] of at least 0, not {speed}")
    return speed


def read_load(message: WrenchStamped) -> tuple[str, tuple[float, float]]:
    """Return the station of a load and its force (x, y) [N], neither of them checked."""
    force = message.wrench.force
    return message.header.frame_id, (force.x, force.y)


def read_temperature(message: Temperature) -> float:
    """Return a temperature [deg C].

    Raises
    ------
    InputError
        If it is not finite or below absolute zero.
    """
    celsius = float(message.temperature)
    if not _ABSOLUTE_ZERO <= celsius < math.inf:
        raise InputError(
            f"temperature must be a finite number [deg C] of at least {_ABSOLUTE_ZERO}, "
            f"not {celsius}"
        )
    return celsius


def speed_message(stamp: Time, speed: float, angle: float) -> JointState:
    """Return the message of a rotor speed [rad/s] and a keyphasor angle [rad]."""
    header = Header(stamp=stamp.to_msg())
    return JointState(header=header, name=["rotor"], position=[angle], velocity=[speed])


def eccentricity_message(
    stamp: Time,
    frame: str,
    journals: Journals,
    others: Journals,
    speed: float,
    measured: Mapping[str, float] | None = None,
) -> JointState:
    """Return the eccentricities of all journals, of their clearances.

    `others` are those on the other stable branch, empty where there is none, and `measured` the
    greatest ones of measured orbits. The speed at which they are [rad/s] stands beside each in
    `velocity`, as in the answers to what-if questions.
    """
    message = numbers_message(stamp, frame, dict(eccentricities(journals, others, measured)))
    message.velocity = array("d", [speed] * len(message.name))
    return message


def harmonics_message(stamp: Time, frame: str, journals: Journals) -> JointState:
    """Return the harmonics of all journals: x = X0 + sum A_i cos(i W t - phase_i), and so y.

    The mean X0 and the amplitudes A_i, zero to peak, are in metres. The phases are lags [rad], as
    in vibration monitoring, and NaN where an amplitude is too small to have one.
    """
    return numbers_message(stamp, frame, named_harmonics(journals))


def heartbeat_message(stamp: Time, frame: str) -> Header:
    """Return a sign of life."""
    return Header(stamp=stamp.to_msg(), frame_id=frame)


def diagnostics_message(
    stamp: Time, node: str, hardware: str, statuses: Iterable[Status]
) -> DiagnosticArray:
    """Return what a node says about itself, named `node: subject` after REP 107."""
    message = DiagnosticArray(header=Header(stamp=stamp.to_msg()))
    message.status = [status_message(node, hardware, status) for status in statuses]
    return message


def status_message(node: str, hardware: str, status: Status) -> DiagnosticStatus:
    """Return how one subject of a node fares."""
    return DiagnosticStatus(
        level=bytes([status.level]),
        name=f"{node}: {status.subject}",
        message=status.message,
        hardware_id=hardware,
        values=[KeyValue(key=key, value=value) for key, value in status.values.items()],
    )


def numbers_message(stamp: Time, frame: str, numbers: Mapping[str, float]) -> JointState:
    """Return a message of named numbers."""
    header = Header(stamp=stamp.to_msg(), frame_id=frame)
    # An array, as rclpy would look at every number of a list.
    position = array("d", numbers.values())
    return JointState(header=header, name=list(numbers), position=position)


def eccentricities(
    journals: Journals, others: Journals, measured: Mapping[str, float] | None = None
) -> Named:
    """Yield the eccentricities of all journals with their names.

    Those on the other stable branch are NaN where there is none, and so are measured ones; where
    nothing can be measured, there are no names of them.
    """
    for damper, motion in journals.items():
        static_x, static_y = motion.coefficients[0] / motion.clearance
        yield f"{damper}/max", motion.eccentricity_max
        yield f"{damper}/mean", motion.eccentricity_mean
        yield f"{damper}/static_x", float(static_x)
        yield f"{damper}/static_y", float(static_y)
        other = others[damper].eccentricity_max if damper in others else math.nan
        yield f"{damper}/other_branch/max", other
        if measured is not None:
            yield f"{damper}/measured/max", measured.get(damper, math.nan)


def named(message: JointState) -> Named:
    """Yield the named positions of a message.

    Raises
    ------
    InputError
        If there are more than `MOST_NAMES`, or names and numbers do not pair.
    """
    if len(message.name) > MOST_NAMES:
        raise InputError(f"name must hold at most {MOST_NAMES} names, not {len(message.name)}")
    if len(message.name) != len(message.position):
        raise InputError(
            f"position must hold a number for each of the {len(message.name)} names, "
            f"not {len(message.position)}"
        )
    yield from zip(message.name, message.position, strict=True)
