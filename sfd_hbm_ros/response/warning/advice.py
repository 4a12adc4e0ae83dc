"""What the alarm has to say, in one sentence for an operator."""

import math

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.tracking.measurements import UNSEEN, Seen
from sfd_hbm_ros.response.warning.alarm import AlarmState
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.limits import Cause, Side
from sfd_hbm_ros.response.warning.outlook import JumpAhead, Outlook
from sfd_hbm_ros.response.warning.rounding import Rounding
from sfd_hbm_ros.response.warning.settings import Level
from sfd_hbm_ros.units import RPM

_STANDING = {
    AlarmState.NORMAL: "",
    AlarmState.UNACKNOWLEDGED: "; to be acknowledged",
    AlarmState.ACKNOWLEDGED: "; acknowledged",
    AlarmState.RETURNED: "; the warning has gone and is to be acknowledged",
    AlarmState.LATCHED: "; the warning has gone, is acknowledged and to be reset",
}


def advice(
    alarm: JumpAlarm,
    outlook: Outlook,
    eccentricity: float,
    now: float,
    rounding: Rounding | None = None,
    seen: Seen = UNSEEN,
) -> str:
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
    rounding : Rounding, optional
        What rounds the numbers, and has rounded those of the sentences before.
    seen : Seen, optional
        What measured orbits say. Where the model is another's, what it says is called doubtful.
    """
    rounding = rounding or Rounding()
    ahead = _about_responses if outlook.others else _about_one
    parts = (
        _about_doubt(seen, rounding),
        ahead(alarm, outlook, eccentricity, now, rounding),
        _about_level(alarm, now, rounding),
        _about_alarm(alarm, now, rounding),
    )
    return "".join(parts)


def _about_doubt(seen: Seen, rounding: Rounding) -> str:
    """Why what follows is doubtful, if it is."""
    if not seen.differs:
        return ""
    shown = rounding.nearest("disagreement", 100.0 * seen.disagreement, 10.0)
    measured = ""
    if math.isfinite(seen.eccentricity):
        eccentricity = rounding.nearest("measured", seen.eccentricity, 0.01)
        measured = f", at a measured eccentricity of {eccentricity:.2f}"
    limit = f"the limit is {100.0 * seen.threshold:.3g} %"
    return f"Doubtful, as model and machine differ by about {shown:.0f} %, {limit}{measured}: "


def _about_one(
    alarm: JumpAlarm, outlook: Outlook, eccentricity: float, now: float, rounding: Rounding
) -> str:
    """What lies ahead of a machine whose response is known, or of which nothing is."""
    limit = alarm.settings.threshold("eccentricity_{}", Level.WARN)
    lock_up = 0.0 < limit < eccentricity
    shown = rounding.nearest("eccentricity", eccentricity, 0.01) if lock_up else math.nan
    near = f"Film near lock-up at eccentricity {shown:.2f}. " if lock_up else ""
    jump = outlook.next
    if math.isinf(jump.speed):
        passed = alarm.held_for(now) > 0.0 and not lock_up
        other = "; another stable response exists at this speed" if outlook.bistable else ""
        return f"{near}No jump ahead{' any more' if passed else ''}{_reach(outlook)}{other}"
    if math.isnan(jump.speed):
        return f"{near}It is not known whether a jump lies ahead"
    return near + _about_jump(outlook, "", rounding)


def _about_responses(
    alarm: JumpAlarm, outlook: Outlook, eccentricity: float, now: float, rounding: Rounding
) -> str:
    """What lies ahead of a machine that may be on one response or another."""
    outlooks = outlook, *outlook.others
    parts = []
    for number, one in enumerate(sorted(outlooks, key=lambda one: one.eccentricity)):
        key = f"{number} of {len(outlooks)} "
        shown = rounding.nearest(f"{key}eccentricity", one.eccentricity, 0.01)
        jump = one.next
        if math.isinf(jump.speed):
            then = f"no jump ahead{_reach(one)}"
        elif math.isnan(jump.speed):
            then = "it is not known whether a jump lies ahead"
        else:
            then = _about_jump(one, key, rounding)
            then = then[0].lower() + then[1:]
        parts.append(f"at eccentricity {shown:.2f}, {then}")
    return (
        f"It is not known on which of {len(outlooks)} responses the machine is: either "
        f"{', or '.join(parts)}; an orbit on ~/measured would settle it"
    )


def _reach(outlook: Outlook) -> str:
    """How far it is known that there is none."""
    up, down = (jump.reach / RPM for jump in (outlook.run_up, outlook.coast_down))
    if math.isfinite(up) and math.isfinite(down):
        return f" from {down:.0f} to {up:.0f} rpm"
    rising = outlook.next.direction is Direction.RUN_UP
    reach = up if rising else down
    return f" {'up' if rising else 'down'} to {reach:.0f} rpm" if math.isfinite(reach) else ""


def _about_jump(outlook: Outlook, key: str, rounding: Rounding) -> str:
    """A jump that is expected: of what, where to and how far away."""
    speed = rounding.rpm(f"{key}speed", outlook.next.speed / RPM)
    landing, way = _landing(outlook.next, key, rounding), _way(outlook, key, rounding)
    return f"{landing} expected at {speed}, {way}"


def _landing(jump: JumpAhead, key: str, rounding: Rounding) -> str:
    """Which damper jumps, and where to."""
    damper, before, after = jump.leading
    of = f" of {damper}" if damper else ""
    if math.isnan(after):
        return f"Jump{of} to an unknown response"
    shown = rounding.nearest(f"{key}after", after, 0.01)
    return f"Jump{of} {'up' if after > before else 'down'} to eccentricity {shown:.2f}"


def _way(outlook: Outlook, key: str, rounding: Rounding) -> str:
    """How soon a jump comes or, where the speed does not tell that, how far away it is."""
    time = outlook.time_to_jump
    if math.isfinite(time):
        return f"in {rounding.within_time(f'{key}time', time)} at the present acceleration"
    distance = rounding.within_rpm(f"{key}margin", outlook.margin / RPM)
    side = "above" if outlook.next.direction is Direction.RUN_UP else "below"
    return f"{distance} {side} the present speed"


def _about_level(alarm: JumpAlarm, now: float, rounding: Rounding) -> str:
    """Why the level is what it is."""
    causes = alarm.causes(now)
    if causes:
        return "".join(f"; {_held(cause)}" for cause in causes)
    rest = alarm.held_for(now)
    if not rest:
        return _about_latch(alarm, now)
    soon = rounding.within_time("held for", rest)
    return f"; no limit is passed any more, {alarm.level(now).name} ends in {soon}"


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


def _about_latch(alarm: JumpAlarm, now: float) -> str:
    """That a level is latched while another alarm, which is active, is spoken of."""
    level = alarm.level(now)
    own = alarm.alarms.get(level)
    if own is None or own.active or own is alarm.leading:
        return ""
    return f"; {level.name} is latched, the warning has gone that raised it"


def _about_alarm(alarm: JumpAlarm, now: float, rounding: Rounding) -> str:
    """Where the alarm stands."""
    shelved = alarm.shelved_for(now)
    if shelved:
        return f"; shelved for {rounding.within_time('shelved for', shelved)} more"
    return _STANDING[alarm.state(now)]
