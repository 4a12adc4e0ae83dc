"""What `sweep` says of a response curve: the contract's JSON object, and the same for people."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.commands.arguments import truncation_sentence
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.solve import sag_sentences, static_sags
from sfd_hbm_ros.report.abscissa import Abscissa
from sfd_hbm_ros.report.units import length_text
from sfd_hbm_ros.response.curves.accuracy import curve_error
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.jumps import Direction, Jump
from sfd_hbm_ros.response.curves.peaks import DiskVibration, Peak
from sfd_hbm_ros.response.curves.summary import Mark, Summary
from sfd_hbm_ros.response.responses import Response, vibration
from sfd_hbm_ros.units import RPM


def data_of(summary: Summary, seconds: float) -> dict[str, Any]:
    """The contract's JSON object; what varies goes by its path, or is the speed.

    The width of the hysteresis is in rpm, or in the unit of the entry that varies. Vibrations are
    zero to peak [m].
    """
    curve, width, varied = summary.curve, summary.hysteresis, Abscissa.of(summary.curve)
    read = _Reader(summary, varied)
    return {
        "points": sum(len(branch.values) for branch in curve.every_branch),
        "varies": {"key": varied.path or "speed", "unit": varied.symbol},
        "folds": [read.mark(mark) for mark in summary.folds],
        "jumps": [read.jump(jump) for jump in summary.jumps],
        "instabilities": [
            {"kind": kind.value, **read.mark(mark)} for kind, mark in summary.instabilities
        ],
        "peak": read.highest(),
        "peaks": [read.peak(peak) for peak in (*summary.peaks, *summary.disk_peaks)],
        "greatest_vibration": read.vibration(summary.greatest_vibration, place=True),
        "hysteresis": None if width is None else width / varied.unit,
        "amplification_factor": summary.amplification_factor,
        "tiny_folds": [read.mark(mark) for mark in summary.tiny_folds],
        "tiny_jumps": [read.jump(jump) for jump in summary.tiny_jumps],
        "gaps": [
            {"from": read.at(gap.low), "to": read.at(gap.high), "reason": gap.reason}
            for gap in curve.gaps
        ],
        "ends": [branch.stop.value for branch in curve.branches],
        "quasi_periodic": [_reach(branch) for branch in curve.branches if not branch.periodic],
        "detached": [
            {
                **_reach(branch),
                "folds": [read.mark(mark) for mark in folds],
                "jumps": [read.jump(jump) for jump in jumps],
            }
            for branch, folds, jumps in summary.detached
        ],
        "stable_anywhere": summary.anywhere_stable,
        **({"sag": static_sags(curve.balance)} if varied.path is None else {}),
        "harmonics": curve.balance.harmonics.highest,
        "truncation_error": curve_error(curve),
        "seconds": seconds,
    }


class _Reader:
    """Turns readings of a curve into the JSON object's."""

    def __init__(self, summary: Summary, varied: Abscissa) -> None:
        self._summary, self._varied = summary, varied
        self._rpm = summary.curve.branches[0].solutions[0].speed / RPM

    def at(self, value: float) -> dict[str, float]:
        """Where a reading lies."""
        if self._varied.path is None:
            return {"speed_rpm": value / RPM}
        return {"speed_rpm": self._rpm, self._varied.path: value}

    def mark(self, mark: Mark) -> dict[str, Any]:
        """A point, with the eccentricity of the damper that is named and those of all."""
        read = {**self.at(mark.value), "damper": mark.damper, "eccentricity": mark.eccentricity}
        return {**read, "vibration": mark.vibration, "dampers": _dampers(mark.response)}

    def highest(self) -> dict[str, Any]:
        """Where the vibration is greatest, and whether that is a peak, at a jump or at an end."""
        summary, mark = self._summary, self._summary.peak
        peaks = [(peak.of, peak.value) for peak in summary.peaks]
        if (mark.damper, mark.value) in peaks:
            kind = "peak"
        elif any(jump.value == mark.value for jump in summary.jumps):
            kind = "jump"
        else:
            kind = "end of the range"
        return {**self.mark(mark), "at": kind if mark.damper else None}

    def peak(self, peak: Peak) -> dict[str, Any]:
        """A peak of a damper's or a disk's vibration."""
        motion = peak.response.journals.get(peak.of)
        return {
            "of": peak.of,
            **self.at(peak.value),
            "vibration": peak.vibration,
            "eccentricity": (motion or peak.response).eccentricity_max,
            "amplification_factor": peak.amplification_factor,
        }

    def jump(self, jump: Jump) -> dict[str, Any]:
        """A jump, with what every damper does."""
        before, after = _dampers(jump.before), _dampers(jump.after)
        return {
            "direction": self._direction(jump.direction),
            **self.at(jump.value),
            "damper": jump.damper,
            "eccentricity_from": jump.before.eccentricity_max,
            "eccentricity_to": jump.after.eccentricity_max,
            "dampers": {
                name: {
                    f"{key}_{end}": one[name][key]
                    for key in ("eccentricity", "vibration")
                    for end, one in (("from", before), ("to", after))
                }
                for name in before
            },
            **{
                f"greatest_vibration_{end}": self.vibration(
                    self._summary.vibrating(jump.value, response)
                )
                for end, response in (("from", jump.before), ("to", jump.after))
            },
        }

    def vibration(self, found: DiskVibration | None, place: bool = False) -> dict[str, Any] | None:
        """The greatest vibration of any disk, and where it is if that is asked for."""
        if found is None:
            return None
        read: dict[str, Any] = {"of": found.disk, "vibration": found.vibration}
        if not place:
            return read
        return {
            **read,
            **self.at(found.value),
            "eccentricity": found.response.eccentricity_max,
        }

    def _direction(self, direction: Direction) -> str:
        """Only a speed runs up and coasts down."""
        if self._varied.path is None:
            return direction.value
        return "upwards" if direction is Direction.RUN_UP else "downwards"


def _dampers(response: Response | None) -> dict[str, dict[str, float]]:
    """Eccentricity and vibration of every damper."""
    if response is None:
        return {}
    return {
        name: {"eccentricity": motion.eccentricity_max, "vibration": vibration(response, name)}
        for name, motion in response.journals.items()
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


def text_of(data: dict[str, Any], summary: Summary) -> str:
    """The same for people."""
    unit = data["varies"]["unit"]
    lines = [
        f"{data['points']} points in {data['seconds']:.2f} s",
        truncation_sentence(data["harmonics"], data["truncation_error"]),
        *(sag_sentences(summary.curve.balance) if "sag" in data else ()),
        *_peaks_text(data),
        *(f"fold    {_point_text(fold)}" for fold in data["folds"]),
        *(f"jump    {_jump_text(jump, data)}" for jump in data["jumps"]),
        *(f"{one['kind']} {_point_text(one)}" for one in data["instabilities"]),
        *(f"quasi-periodic  {_reach_text(one)}" for one in data["quasi_periodic"]),
    ]
    for one in data["detached"]:
        lines.append(f"detached  {_reach_text(one)}")
        lines += [f"  fold    {_point_text(fold)}" for fold in one["folds"]]
        lines += [f"  jump    {_jump_text(jump, data)}" for jump in one["jumps"]]
    if data["hysteresis"] is not None:
        lines.append(f"hysteresis {data['hysteresis']:.6g} {unit}".rstrip() + " wide")
    if data["tiny_folds"] or data["tiny_jumps"]:
        lines.append("too small to see (below 0.01 of the clearance or 0.1 rpm):")
    lines += [f"  fold    {_point_text(fold)}" for fold in data["tiny_folds"]]
    lines += [f"  jump    {_jump_text(jump, data)}" for jump in data["tiny_jumps"]]
    ends = [*data["ends"], *(one["end"] for one in data["detached"])]
    expected = Stop.RANGE.value, Stop.CLOSED.value
    lines += [
        f"no response was found from {_place(gap['from']).strip()} to "
        f"{_place(gap['to']).strip()}{': ' if gap['reason'] else ''}{gap['reason']}"
        for gap in data["gaps"]
    ]
    lines += [f"ended: {end}" for end in ends if end not in expected]
    return "\n".join(lines)


def _peaks_text(data: dict[str, Any]) -> Iterator[str]:
    """Peaks, the greatest vibration where that is none of them, and the greatest of a disk."""
    for peak in data["peaks"]:
        line = f"peak    {_place(peak)}: {peak['of']} vibrates {length_text(peak['vibration'])} "
        line += f"zero to peak at eccentricity {peak['eccentricity']:.4f}"
        factor = peak["amplification_factor"]
        yield line + ("" if factor is None else f", with an amplification factor of {factor:.3g}")
    highest, greatest = data["peak"], data["greatest_vibration"]
    if highest["at"] not in (None, "peak"):
        where = (
            "peak    {}, cut off by a jump"
            if highest["at"] == "jump"
            else ("no peak within the range; greatest vibration at {}")
        )
        yield (
            f"{where.format(_place(highest))}: {highest['damper']} vibrates "
            f"{length_text(highest['vibration'])} zero to peak at eccentricity "
            f"{highest['eccentricity']:.4f}"
        )
    if greatest is not None:
        yield (
            f"greatest vibration of any disk {length_text(greatest['vibration'])} zero to peak: "
            f"{greatest['of']} at {_place(greatest).strip()}, at eccentricity "
            f"{greatest['eccentricity']:.4f}"
        )


def _point_text(mark: dict[str, Any]) -> str:
    """A point with the eccentricities of all dampers, that of the worst first."""
    others = [name for name in mark["dampers"] if name != mark["damper"]]
    parts = [
        f"of {name} {mark['dampers'][name]['eccentricity']:.4f}"
        for name in (mark["damper"], *others)
    ]
    return f"{_place(mark)}: eccentricity {', '.join(parts)}"


def _jump_text(jump: dict[str, Any], data: dict[str, Any]) -> str:
    """A jump with every damper's eccentricity before and after, the one that jumps most first."""
    way = jump["direction"].replace("_", "-")
    if data["varies"]["key"] != "speed":
        way += f" in {data['varies']['key']}"
    others = [name for name in jump["dampers"] if name != jump["damper"]]
    parts = [
        f"of {name} {jump['dampers'][name]['eccentricity_from']:.4f} to "
        f"{jump['dampers'][name]['eccentricity_to']:.4f}"
        for name in (jump["damper"], *others)
    ]
    text = f"{_place(jump)}: {way}, eccentricity {', '.join(parts)}"
    before, after = (jump[f"greatest_vibration_{end}"] for end in ("from", "to"))
    if before is None or after is None:
        return text
    return (
        f"{text}; greatest vibration of any disk {length_text(before['vibration'])} "
        f"({before['of']}) to {length_text(after['vibration'])} ({after['of']})"
    )


def _reach_text(one: dict[str, Any]) -> str:
    low, high = one["speed_rpm"]
    least, most = one["eccentricity"]
    return f"{low:.2f} to {high:.2f} rpm: eccentricity {least:.4f} to {most:.4f}"


def _place(mark: dict[str, Any]) -> str:
    """Where a mark lies: the entry that varies, or the speed."""
    path = next((key for key in mark if "." in key), None)
    return f"{path} = {mark[path]:.6g}" if path else f"{mark['speed_rpm']:9.2f} rpm"
