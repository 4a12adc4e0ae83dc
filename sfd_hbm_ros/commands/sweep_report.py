"""What `sweep` says of a response curve: the contract's JSON object, and the same for people."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.commands.arguments import truncation_sentence
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curves.accuracy import curve_error
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.summary import Mark, Summary
from sfd_hbm_ros.units import RPM


def data_of(summary: Summary, path: str | None, seconds: float) -> dict[str, Any]:
    """The contract's JSON object; what varies goes by its path, or is the speed.

    The width of the hysteresis is in rpm, or in the unit of the entry that varies.
    """
    curve, width, unit = summary.curve, summary.hysteresis, RPM if path is None else 1.0
    rpm = curve.branches[0].solutions[0].speed / RPM

    def at(value: float) -> dict[str, float]:
        return {"speed_rpm": value / RPM} if path is None else {"speed_rpm": rpm, path: value}

    def marked(mark: Mark) -> dict[str, float]:
        return {**at(mark.value), "eccentricity": mark.eccentricity}

    return {
        "points": sum(len(branch.values) for branch in curve.every_branch),
        "folds": [marked(mark) for mark in summary.folds],
        "jumps": [
            {
                "direction": jump.direction.value,
                **at(jump.value),
                "eccentricity_from": jump.before.eccentricity_max,
                "eccentricity_to": jump.after.eccentricity_max,
            }
            for jump in summary.jumps
        ],
        "instabilities": [
            {"kind": kind.value, **marked(mark)} for kind, mark in summary.instabilities
        ],
        "peak": marked(summary.peak),
        "hysteresis": None if width is None else width / unit,
        "amplification_factor": summary.amplification_factor,
        "ends": [branch.stop.value for branch in curve.branches],
        "quasi_periodic": [_reach(branch) for branch in curve.branches if not branch.periodic],
        "detached": [_reach(branch) for branch in curve.detached],
        "harmonics": curve.balance.harmonics.highest,
        "truncation_error": curve_error(curve),
        "seconds": seconds,
    }


def _reach(branch: CurveBranch) -> dict[str, Any]:
    """Why a branch ends, where it lies and where it is stable; NaN where it nowhere is."""
    rpm, eccentricity, stable = branch.speed / RPM, branch.worst_eccentricity, branch.stable

    def span(values: NDArray[np.float64]) -> list[float]:
        return [float(values.min()), float(values.max())] if values.size else [math.nan, math.nan]

    return {
        "speed_rpm": span(rpm),
        "eccentricity": span(eccentricity),
        "stable_rpm": span(rpm[stable]),
        "end": branch.stop.value,
    }


def text_of(data: dict[str, Any]) -> str:
    """The same for people."""
    lines = [
        f"{data['points']} points in {data['seconds']:.2f} s",
        truncation_sentence(data["harmonics"], data["truncation_error"]),
    ]
    lines += [f"peak    {_place(data['peak'])}: eccentricity {data['peak']['eccentricity']:.4f}"]
    lines += [
        f"fold    {_place(fold)}: eccentricity {fold['eccentricity']:.4f}"
        for fold in data["folds"]
    ]
    for jump in data["jumps"]:
        way = jump["direction"].replace("_", "-")
        lines.append(
            f"jump    {_place(jump)}: {way}, eccentricity {jump['eccentricity_from']:.4f} to "
            f"{jump['eccentricity_to']:.4f}"
        )
    lines += [
        f"{one['kind']} {_place(one)}: eccentricity {one['eccentricity']:.4f}"
        for one in data["instabilities"]
    ]
    lines += [
        f"{name}  {one['speed_rpm'][0]:.2f} to {one['speed_rpm'][1]:.2f} rpm: eccentricity "
        f"{one['eccentricity'][0]:.4f} to {one['eccentricity'][1]:.4f}"
        for name, key in (("quasi-periodic", "quasi_periodic"), ("detached", "detached"))
        for one in data[key]
    ]
    if data["hysteresis"] is not None:
        lines.append(f"width of the hysteresis {data['hysteresis']:.6g}")
    if data["amplification_factor"] is not None:
        lines.append(f"amplification factor {data['amplification_factor']:.3f}")
    ends = [*data["ends"], *(one["end"] for one in data["detached"])]
    expected = Stop.RANGE.value, Stop.CLOSED.value
    lines += [f"ended: {end}" for end in ends if end not in expected]
    return "\n".join(lines)


def _place(mark: dict[str, Any]) -> str:
    """Where a mark lies: the entry that varies, or the speed."""
    path = next((key for key in mark if "." in key), None)
    return f"{path} = {mark[path]:.6g}" if path else f"{mark['speed_rpm']:9.2f} rpm"
