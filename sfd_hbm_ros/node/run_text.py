"""A run as text for people: one row for each damper and second, and a summary. Without ROS."""

from sfd_hbm_ros.node.run_record import DamperPoint, RunPoint, RunRecord

_ORDERS = 3
_MICRO = 1e6  # micrometres in a metre
_MISSING = "-"
_LEVELS = {0: "OK", 1: "WARN", 2: "ERROR", 3: "STALE"}  # of diagnostic_msgs/DiagnosticStatus

HEADER = (
    "  time   speed  damper              eccentricity e/c    x, zero to peak [um]\n"
    "   [s]   [rpm]                         max      mean      1x      2x      3x"
)
"""Two lines above the rows; e/c is a ratio, of the clearance."""


def rows(point: RunPoint) -> str:
    """Return a line for each damper, or one if nothing was predicted."""
    when = f"{point.time:6.1f}  {point.rpm:6.0f}  "
    dampers = [f"{name:<16}{_numbers(damper)}" for name, damper in point.dampers.items()]
    return "\n".join(when + text for text in dampers or ["no prediction"])


def diagnosis(name: str, level: int, message: str) -> str:
    """Return the line for a status of the diagnostics."""
    return f"{'':16}{name} {_LEVELS.get(level, 'unknown')}: {message}"


def summary(record: RunRecord) -> str:
    """Return lines on the number of predictions, the peaks and the hysteresis."""
    unsolved = sum(not point.solved for point in record.points)
    predictions = f"{len(record.points)} predictions, {unsolved} of them without a solution"
    count = f"{record.speeds} speeds, {predictions}"
    return "\n".join([count, *(line for name in record.dampers for line in _about(record, name))])


def _numbers(damper: DamperPoint) -> str:
    """Return the columns of one damper; a harmonic that was not predicted has a dash."""
    eccentricity = f"{damper.eccentricity_max:10.4f}{damper.eccentricity_mean:10.4f}"
    microns = [f"{_MICRO * amplitude:.3f}" for amplitude in damper.amplitudes[:_ORDERS]]
    shown = microns + [_MISSING] * (_ORDERS - len(microns))
    return eccentricity + "".join(f"{text:>8}" for text in shown)


def _about(record: RunRecord, name: str) -> list[str]:
    """Return the lines of one damper."""
    lines = []
    for words, direction in (("up", 1), ("down", -1)):
        way = record.way(name, direction)
        if way.size:
            rpm, eccentricity = way[way[:, 1].argmax()]
            peak = f"peak eccentricity {eccentricity:.4f} at {rpm:.0f} rpm"
            lines.append(f"{name}, on the way {words}: {peak}")
    difference = record.largest_difference(name)
    if difference is not None:
        apart, rpm = difference
        lines.append(f"{name}, up and down differ by at most {apart:.4f}, at {rpm:.0f} rpm")
    return lines
