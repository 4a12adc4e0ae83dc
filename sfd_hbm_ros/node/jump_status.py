"""The warning of a jump as a status: a level, a sentence and what programs want to read."""

from __future__ import annotations

from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.response.tracking.measurements import UNSEEN, Seen
from sfd_hbm_ros.response.tracking.tracked import BranchName
from sfd_hbm_ros.response.warning.advice import advice
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.outlook import Outlook
from sfd_hbm_ros.response.warning.rounding import Rounding
from sfd_hbm_ros.units import RPM


def jump_status(
    alarm: JumpAlarm,
    outlook: Outlook,
    branch: BranchName,
    eccentricity: float,
    model_age: float,
    now: float,
    rounding: Rounding | None = None,
    seen: Seen = UNSEEN,
) -> Status:
    """Return the warning; +inf stands for none ahead, NaN for not computable (REP 117).

    Parameters
    ----------
    alarm : JumpAlarm
        The alarm, which has taken the outlook and the eccentricity.
    outlook : Outlook
        What lies ahead.
    branch : BranchName
        The branch that the machine is on.
    eccentricity : float
        Greatest eccentricity of any damper at present; NaN if unknown.
    model_age : float
        Time since the response curve was that of the machine as it is [s]; 0 while it is.
    now : float
        Time by the alarm's clock [s].
    rounding : Rounding, optional
        What rounds the numbers of the sentence.
    seen : Seen, optional
        What measured orbits say.
    """
    leading, ahead = alarm.leading, outlook.next
    values = {
        "branch": str(branch),
        "bistable": "unknown" if outlook.bistable is None else str(outlook.bistable).lower(),
        "next_jump": str(ahead.direction),
        "next_jump_rpm": _number(ahead.speed / RPM),
        "next_jump_damper": ahead.leading.damper,
        "margin_rpm": _number(outlook.margin / RPM),
        "margin_percent": _number(100.0 * outlook.relative_margin),
        "time_to_jump_s": _number(outlook.time_to_jump),
        "eccentricity": _number(eccentricity),
        "measured_eccentricity": _number(seen.eccentricity).replace("-inf", "nan"),
        "measured_disagreement": _number(seen.disagreement),
        "doubtful": str(seen.differs).lower(),
        "eccentricity_after": _number(ahead.eccentricity_after),
        "run_up_jump_rpm": _number(outlook.run_up.speed / RPM),
        "coast_down_jump_rpm": _number(outlook.coast_down.speed / RPM),
        "possible": "; ".join(_possible(one) for one in (outlook, *outlook.others))
        if outlook.others
        else "",
        "alarm": str(alarm.state(now)),
        "held_by": "; ".join([*_doubt(seen), *(str(cause) for cause in alarm.causes(now))]),
        "since_s": _number(now - leading.since),
        "occurrences": str(leading.occurrences),
        "model_age_s": _number(model_age),
    }
    sentence = advice(alarm, outlook, eccentricity, now, rounding, seen)
    return Status("Jump", alarm.level(now), sentence, values)


def _doubt(seen: Seen) -> list[str]:
    """Return what holds a warning whatever the model says."""
    if not seen.differs:
        return []
    values = f"{_number(seen.disagreement)} of the orbit, limit {_number(seen.threshold)}"
    return [f"difference of model and machine {values}"]


def _possible(outlook: Outlook) -> str:
    """Return a response that the machine may be on, and its jumps."""
    up, down = (_number(jump.speed / RPM) for jump in (outlook.run_up, outlook.coast_down))
    eccentricity = _number(outlook.eccentricity)
    return f"eccentricity {eccentricity}, run_up jump at {up} rpm, coast_down jump at {down} rpm"


def _number(value: float) -> str:
    """Return a number with six digits."""
    return f"{value:.6g}"
