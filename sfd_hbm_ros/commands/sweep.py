"""The response over a range of speeds, or of any entry of the machine file at one speed."""

import argparse
import time
from typing import Any

from sfd_hbm_ros.commands.arguments import (
    RPM,
    add_harmonics,
    add_machine,
    print_json,
    read_changed_machine,
    speed_from,
)
from sfd_hbm_ros.commands.progress import Progress
from sfd_hbm_ros.commands.ranges import range_from, varied_from
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.response.curve import ResponseCurve, parameter_curve, response_curve
from sfd_hbm_ros.response.summary import Mark, Summary


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument(
        "--rpm", required=True, metavar="A:B", help="speeds [rpm]; with --vary a single one"
    )
    parser.add_argument("--vary", metavar="PATH=A:B", help="vary an entry of the machine file")
    add_harmonics(parser)
    parser.add_argument("--output", metavar="F.csv", help="write the points as CSV, in arc order")
    parser.add_argument("--picture", metavar="F.png", help="draw the response curve")


def run(chosen: argparse.Namespace) -> None:
    """Follow the response and print what it shows."""
    started = time.perf_counter()
    summary = Summary(_curve(chosen))
    seconds = time.perf_counter() - started
    if chosen.output:
        from sfd_hbm_ros.report.table import write_table

        write_table(summary.curve, chosen.output)
    if chosen.picture:
        _draw(summary, chosen.picture)
    data = _data(summary, None if chosen.vary is None else chosen.vary.partition("=")[0], seconds)
    if chosen.json:
        print_json(data)
    else:
        print(_text(data))


def _draw(summary: Summary, path: str) -> None:
    """The response of every damper above one another, with the jumps."""
    from sfd_hbm_ros.report.curves import draw_response  # matplotlib takes its time to import
    from sfd_hbm_ros.report.style import new_figure, save

    dampers = summary.curve.dampers
    figure, axes = new_figure(rows=len(dampers), size=(6.3, 3.7 * len(dampers)), share_x=True)
    for one, damper in zip(axes, dampers, strict=True):
        draw_response(one, summary.curve, damper, summary.jumps)
        if len(dampers) > 1:
            one.set_title(damper)
    save(figure, path)


def _curve(chosen: argparse.Namespace) -> ResponseCurve:
    machine = read_changed_machine(chosen)
    balance = HarmonicBalance(machine, Harmonics(chosen.harmonics))
    if chosen.vary is None:
        lowest, highest = sorted(range_from("--rpm", chosen.rpm))
        speeds = speed_from(lowest), speed_from(highest)
        with Progress(lambda n, speed: f"{n} points, {speed / RPM:.1f} rpm") as progress:
            return response_curve(balance, *speeds, progress=progress)
    path, start, end = varied_from(chosen.vary, machine)
    with Progress(lambda n, value: f"{n} points, {path} = {value:.6g}") as progress:
        return parameter_curve(
            balance, speed_from(_number(chosen.rpm)), path, start, end, progress=progress
        )


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"--rpm {text}: must be a single speed with --vary") from None


def _data(summary: Summary, path: str | None, seconds: float) -> dict[str, Any]:
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
        "points": sum(len(branch.values) for branch in curve.branches),
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
        "seconds": seconds,
    }


def _text(data: dict[str, Any]) -> str:
    """The same for people."""
    lines = [f"{data['points']} points in {data['seconds']:.2f} s"]
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
    if data["hysteresis"] is not None:
        lines.append(f"width of the hysteresis {data['hysteresis']:.6g}")
    if data["amplification_factor"] is not None:
        lines.append(f"amplification factor {data['amplification_factor']:.3f}")
    lines += [f"ended: {end}" for end in data["ends"] if end != Stop.RANGE.value]
    return "\n".join(lines)


def _place(mark: dict[str, Any]) -> str:
    """Where a mark lies: the entry that varies, or the speed."""
    path = next((key for key in mark if "." in key), None)
    return f"{path} = {mark[path]:.6g}" if path else f"{mark['speed_rpm']:9.2f} rpm"
