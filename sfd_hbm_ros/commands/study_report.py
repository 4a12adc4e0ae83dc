"""What `study` says of all the variants: a JSON object, and the same for people."""

from typing import Any

import numpy as np

from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.units import RPM

_PERCENTILES = (5, 50, 95)


def data_of(
    results: Results, kept: int, seconds: float, operating: float | None = None
) -> dict[str, Any]:
    """The JSON object; `kept` variants were in the journal before, the rest took `seconds`.

    What concerns the `operating` speed [rpm] is None where there is no such speed.
    """
    solved = int(results.solved.sum())
    return {
        "variants": len(results.outcomes),
        "from_journal": kept,
        "without_solution": len(results.outcomes) - solved,
        "incomplete": sum(
            one.peak_speed is not None and bool(one.reason) for one in results.outcomes
        ),
        "jumps": [_jumps(results, direction, solved) for direction in Direction],
        "several_responses": _several(results, solved),
        "locked_up": {"probability": _share(results, "locked_up", solved)},
        "detached": {"probability": _share(results, "detached", solved)},
        "at": _at(results, operating),
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


def _share(results: Results, key: str, solved: int) -> float | None:
    """The share of the variants with a solution of which something is so; None if not known."""
    known = [getattr(one, key) for one in results.outcomes if getattr(one, key) is not None]
    return sum(map(bool, known)) / solved if known else None


def _several(results: Results, solved: int) -> dict[str, Any]:
    """How many of the variants have more than one stable response, and where."""
    found = [
        (one.several_from / RPM, one.several_to / RPM)
        for one in results.outcomes
        if one.several_from is not None and one.several_to is not None
    ]
    return {
        "probability": len(found) / solved,
        "speed_rpm": [min(found)[0], max(high for _, high in found)] if found else None,
    }


def _at(results: Results, operating: float | None) -> dict[str, Any] | None:
    """The responses at the operating speed [rpm], over the variants that have any there."""
    if operating is None:
        return None
    there = [one for one in results.outcomes if one.responses]
    spans = {
        name: [float(values.min()), float(np.median(values)), float(values.max())]
        for name in ("best_vibration", "worst_vibration")
        if (values := np.array([getattr(one, name) for one in there])).size
    }
    return {
        "speed_rpm": operating,
        "variants": len(there),
        "several_responses": sum((one.responses or 0) > 1 for one in there),
        **{name: spans.get(name) for name in ("best_vibration", "worst_vibration")},
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
    several = data["several_responses"]
    if several["probability"]:
        low, high = several["speed_rpm"]
        lines.append(
            f"{_percent(several['probability'])} have a second stable response somewhere from "
            f"{low:.1f} to {high:.1f} rpm"
        )
    if data["locked_up"]["probability"]:
        lines.append(
            f"{_percent(data['locked_up']['probability'])} stay locked up on the upper response "
            "to the end of the range after a run-up"
        )
    if data["detached"]["probability"]:
        lines.append(
            f"{_percent(data['detached']['probability'])} have a stable response that neither "
            "run-up nor coast-down meets, onto which a shock can throw them"
        )
    return "\n".join([*lines, *_lines_at(data["at"])])


def _lines_at(at: dict[str, Any] | None) -> list[str]:
    """What there is at the operating speed."""
    if at is None:
        return []
    place = f"at {at['speed_rpm']:g} rpm"
    if not at["variants"]:
        return [f"{place} no variant has a stable response"]
    lines = [
        f"{place} {at['several_responses']} of {at['variants']} variants have more than one "
        "stable response"
    ]
    for name in ("best", "worst"):
        low, median, high = at[f"{name}_vibration"]
        lines.append(
            f"{place} the {name} vibration is {low:.4f} to {high:.4f} of the clearance, median "
            f"{median:.4f}"
        )
    return lines


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} % of the variants"
