"""What `study` says of all the variants: a JSON object, and the same for people."""

from typing import Any

import numpy as np

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.units import RPM

_PERCENTILES = (5, 50, 95)


def data_of(results: Results, kept: int, seconds: float) -> dict[str, Any]:
    """The JSON object; `kept` variants were in the journal before, the rest took `seconds`."""
    solved = int(results.solved.sum())
    return {
        "variants": len(results.outcomes),
        "from_journal": kept,
        "without_solution": len(results.outcomes) - solved,
        "incomplete": sum(
            one.peak_speed is not None and bool(one.reason) for one in results.outcomes
        ),
        "jumps": [_jumps(results, direction, solved) for direction in Direction],
        "seconds": seconds,
    }


def _jumps(results: Results, direction: Direction, solved: int) -> dict[str, Any]:
    """How many of the variants with a solution jump, and percentiles of the speed."""
    rpm = results.jump_speeds(direction) / RPM
    return {
        "direction": direction.value,
        "probability": len(rpm) / solved,
        "speed_rpm": {
            f"{percent}%": float(np.percentile(rpm, percent)) if rpm.size else None
            for percent in _PERCENTILES
        },
    }


def text_of(data: dict[str, Any]) -> str:
    """The same for people."""
    lines = [
        f"{data['variants']} variants in {data['seconds']:.1f} s"
        + (f", {data['from_journal']} of them from the journal" if data["from_journal"] else "")
    ]
    lines += [
        f"{data[key]} {words}"
        for key, words in (
            ("without_solution", "without a solution: column reason says why"),
            ("incomplete", "with an incomplete curve: column reason says why"),
        )
        if data[key]
    ]
    for jumps in data["jumps"]:
        way, part = jumps["direction"].replace("_", "-"), 100.0 * jumps["probability"]
        line = f"{way:<10} {part:.3g} % of the variants jump"
        if part:
            low, median, high = jumps["speed_rpm"].values()
            line += f", median {median:.1f} rpm, 90 % from {low:.1f} to {high:.1f} rpm"
        lines.append(line)
    return "\n".join(lines)
