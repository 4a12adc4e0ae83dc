"""A run as text for people: rows, warnings and a summary, in 100 columns. Without ROS."""

import math
import textwrap

import numpy as np

from sfd_hbm_ros.node.monitor.run_point import DamperPoint, RunPoint
from sfd_hbm_ros.node.monitor.run_record import RunRecord
from sfd_hbm_ros.node.monitor.run_warnings import JumpWarning, MetJump, WarningRecord
from sfd_hbm_ros.response.curves.jumps import Direction

_ORDERS = 3
_MICRO = 1e6  # micrometres in a metre
_MISSING = "-"
_UNKNOWN = "?"
_COLUMNS = 99
_LEVELS = {0: "OK", 1: "WARN", 2: "ERROR", 3: "STALE"}  # of diagnostic_msgs/DiagnosticStatus
_WAYS = {Direction.RUN_UP: "up", Direction.COAST_DOWN: "down"}

HEADER = """\
  time   speed  damper         eccentricity e/c       x, zero to peak [um]             next jump
   [s]   [rpm]                  max       other     1x  measured      2x      3x   [rpm]  in [s]"""
"""Two lines above the rows; e/c is a ratio, of the clearance, here and on the other branch."""


def rows(point: RunPoint, warning: JumpWarning | None = None) -> str:
    """Return a line for each damper, or one if nothing was predicted."""
    when = f"{point.time:6.1f}  {point.rpm:6.0f}  "
    ahead = _ahead(point, warning)
    dampers = [f"{name:<12}{_numbers(damper)}{ahead}" for name, damper in point.dampers.items()]
    return "\n".join(when + text for text in dampers or ["no prediction"])


def diagnosis(name: str, level: int, message: str) -> str:
    """Return the lines for a status of the diagnostics."""
    return _wrapped(f"{name} {_LEVELS.get(level, 'unknown')}: {message}")


def alarm(warning: JumpWarning) -> str:
    """Return the lines for a warning."""
    return _wrapped(f"{_LEVELS.get(warning.level, 'unknown')}: {warning.sentence}", "=> ")


def summary(record: RunRecord, warnings: WarningRecord) -> str:
    """Return lines on the number of predictions, peaks, hysteresis, jumps and measurements."""
    unsolved = sum(not point.solved for point in record.points)
    predictions = f"{len(record.points)} predictions, {unsolved} of them without a solution"
    count = f"{record.speeds} speeds, {predictions}"
    about = [line for name in record.dampers for line in _about(record, name)]
    return "\n".join([count, *about, *(_met(jump) for jump in warnings.jumps)])


def _wrapped(text: str, mark: str = "") -> str:
    indent = " " * 16
    begin = indent[len(mark) :] + mark
    return textwrap.fill(text, _COLUMNS, initial_indent=begin, subsequent_indent=indent)


def _numbers(damper: DamperPoint) -> str:
    """Return the columns of one damper; what was not predicted or measured has a dash."""
    other = damper.eccentricity_other
    beside = f"{_MISSING:>12}" if math.isnan(other) else f"{other:12.4f}"
    first, *higher = _microns(damper.amplitudes, _ORDERS)
    shown = [first, *_microns(damper.measured, 1), *higher]
    columns = zip(shown, (7, 10, 8, 8), strict=True)
    numbers = "".join(f"{text:>{width}}" for text, width in columns)
    return f"{damper.eccentricity_max:7.4f}{beside}{numbers}"


def _microns(amplitudes: tuple[float, ...], wanted: int) -> list[str]:
    """Return amplitudes in micrometres."""
    microns = [f"{_MICRO * amplitude:.2f}" for amplitude in amplitudes[:wanted]]
    return microns + [_MISSING] * (wanted - len(microns))


def _ahead(point: RunPoint, warning: JumpWarning | None) -> str:
    """Return the columns of the next jump, seen from a point a little after the warning."""
    if warning is None:
        return ""
    passed = (point.stamp - warning.stamp) * 1e-9
    seconds = max(warning.seconds - passed, 0.0)  # in this order, which keeps NaN
    return _finite(warning.rpm, 0) + _finite(seconds, 1)


def _finite(value: float, digits: int) -> str:
    """Return a number, or a sign for none (infinite) or not computable (NaN)."""
    if math.isfinite(value):
        return f"{value:8.{digits}f}"
    return f"{_UNKNOWN if math.isnan(value) else _MISSING:>8}"


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
    disagreements = record.disagreements(name)
    if disagreements.size:
        median, most = np.percentile(100.0 * disagreements, [50, 99])
        differ = f"by {median:.2g} % (median) and {most:.2g} % (99th percentile)"
        lines.append(
            f"{name}, {disagreements.size} measured orbits: "
            f"1x of x differs from the prediction {differ}"
        )
    return lines


def _met(jump: MetJump) -> str:
    """Return the line of one jump."""
    way = _WAYS[Direction(jump.warning.direction)]
    change = f"eccentricity {jump.before:.4f} to {jump.after:.4f}"
    warned = f"warned {jump.ahead:.1f} s ahead" if math.isfinite(jump.ahead) else "not warned"
    return f"jump at {jump.warning.rpm:.0f} rpm on the way {way}: {change}, {warned}"
