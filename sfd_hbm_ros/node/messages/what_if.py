"""Messages about speeds at which the machine does not run, but might."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from sfd_hbm_ros.node.inputs import InputError
from sfd_hbm_ros.node.messages.common import Journals, eccentricities

MOST = 1000
"""Speeds that may be asked about at once."""


class Answer(NamedTuple):
    """What the machine would do at a speed.

    Attributes
    ----------
    speed : float
        The speed [rad/s].
    journals, others : mapping of str to JournalMotion
        The journals on the machine's branch and on the other stable one, empty if there is none.
    reason : str
        Why nothing is known, where it is not.
    """

    speed: float
    journals: Journals
    others: Journals
    reason: str = ""


def read_what_if(message: JointState) -> list[float]:
    """Return the rotor speeds that are asked about [rad/s].

    Raises
    ------
    InputError
        If there is none or more than `MOST`, or one is not positive or not finite.
    """
    number = len(message.velocity)
    if not 1 <= number <= MOST:
        raise InputError(f"velocity must hold 1 to {MOST} rotor speeds [rad/s], not {number}")
    speeds = [float(speed) for speed in message.velocity]
    for i, speed in enumerate(speeds):
        if not 0.0 < speed < math.inf:
            raise InputError(f"velocity[{i}] must be a finite number [rad/s] above 0, not {speed}")
    return speeds


def refusals(speeds: Sequence[float], journals: Journals, reason: str) -> list[Answer]:
    """Return the answers to a question that is refused, of `MOST` speeds at most.

    `journals` are unknown, and empty where there is no machine.
    """
    first, *others = speeds[:MOST] or [math.nan]
    return [Answer(first, journals, {}, reason), *(Answer(one, journals, {}) for one in others)]


def what_if_message(stamp: Time, frame: str, answers: Sequence[Answer]) -> JointState:
    """Return the eccentricities at speeds that were asked about, in the order of the request.

    The names are those of `eccentricity_message`, repeated for each speed, which stands beside
    them in `velocity`. Where nothing is known all are NaN, and one more says why: "reason: ...".
    """
    rows = [(name, value, answer.speed) for answer in answers for name, value in _numbers(answer)]
    names, values, speeds = zip(*rows, strict=True)
    header = Header(stamp=stamp.to_msg(), frame_id=frame)
    return JointState(header=header, name=names, position=values, velocity=speeds)


def _numbers(answer: Answer) -> Iterator[tuple[str, float]]:
    """Yield the named numbers of one speed."""
    yield from eccentricities(answer.journals, answer.others)
    if answer.reason:
        yield f"reason: {answer.reason}", math.nan
