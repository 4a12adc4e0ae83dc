"""What the alarm has to say, in one sentence for an operator."""

import math

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.warning.alarm import AlarmState
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.limits import Cause, Side
from sfd_hbm_ros.response.warning.outlook import JumpAhead, Outlook
from sfd_hbm_ros.response.warning.settings import Level
from sfd_hbm_ros.units import RPM

_STANDING = {
    AlarmState.NORMAL: "",
    AlarmState.UNACKNOWLEDGED: "; to be acknowledged",
    AlarmState.ACKNOWLEDGED: "; acknowledged",
    AlarmState.RETURNED: "; the warning has gone and is to be acknowledged",
    AlarmState.LATCHED: "; the warning has gone, is acknowledged and to be reset",
}


def advice(alarm: JumpAlarm, outlook: Outlook, eccentricity: float, now: float) -> str:
    """Return the sentence.

    Parameters
    ----------
    alarm : JumpAlarm
        The alarm, which has taken what follows.
    outlook : Outlook
        What lies ahead.
    eccentricity : float
        Greatest eccentricity of any damper at present; NaN if unknown.
    now : float
        Time by the alarm's clock [s].
    """
    limit = alarm.settings.threshold("eccentricity_{}", Level.WARN)
    near = f"Film near lock-up at eccentricity {eccentricity:.2f}. "
    lock_up = near if 0.0 < limit < eccentricity else ""
    passed = alarm.held_for(now) > 0.0 and not lock_up
    return (
        lock_up
        + _about_jump(outlook, passed)
        + _about_level(alarm, now)
        + _about_alarm(alarm, now)
    )


def _about_jump(outlook: Outlook, passed: bool) -> str:
    """What lies ahead; `passed` where an alarm that was raised by a jump is active yet."""
    jump = outlook.next
    if math.isnan(jump.speed):
        return "It is not known whether a jump lies ahead"
    other = "; another stable response exists at this speed" if outlook.bistable else ""
    if math.isinf(jump.speed):
        return f"No jump ahead{' any more' if passed else ''}{other}"
    rpm, percent = outlook.margin / RPM, 100.0 * outlook.relative_margin
    distance = f"{rpm:.0f} rpm ({percent:.1f} %)"
    return f"{_landing(jump)} expected at {jump.speed / RPM:.0f} rpm, {distance} " + _way(outlook)


def _landing(jump: JumpAhead) -> str:
    """Where a jump leads."""
    if math.isnan(jump.eccentricity_after):
        return "Jump to an unknown response"
    way = "up" if jump.upwards else "down"
    return f"Jump {way} to eccentricity {jump.eccentricity_after:.2f}"


def _way(outlook: Outlook) -> str:
    """On which side of the present speed a jump lies, and how soon it comes."""
    time = outlook.time_to_jump
    if math.isfinite(time):
        return f"ahead, in {time:.{0 if time >= 10.0 else 1}f} s at the present acceleration"
    side = "above" if outlook.next.direction is Direction.RUN_UP else "below"
    return f"{side} the present speed"


def _about_level(alarm: JumpAlarm, now: float) -> str:
    """Why the level is what it is."""
    causes = alarm.causes(now)
    if causes:
        return "".join(f"; {_held(cause)}" for cause in causes)
    rest = alarm.held_for(now)
    name = alarm.level(now).name
    return f"; all are behind their limits, {name} ends within {math.ceil(rest)} s" if rest else ""


def _held(cause: Cause) -> str:
    """How a limit holds a level."""
    limit = cause.limit
    side = "above" if limit.above else "below"
    threshold = limit.shown(cause.threshold)
    if cause.side is Side.BEYOND:
        return f"the {limit.about} is {side} its limit of {threshold}"
    if cause.side is Side.UNKNOWN:
        reading = limit.shown(cause.reading)
        return f"the {limit.about} was {reading} when last known, its limit is {threshold}"
    back = "below" if limit.above else "above"
    release = limit.shown(cause.release)
    return f"the {limit.about} is not yet back {back} {release}, its limit is {threshold}"


def _about_alarm(alarm: JumpAlarm, now: float) -> str:
    """Where the alarm stands."""
    shelved = alarm.shelved_for(now)
    return f"; shelved for another {shelved:.0f} s" if shelved else _STANDING[alarm.state(now)]
