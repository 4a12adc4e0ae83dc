"""The response over a range of speeds, or of any entry of the machine file at one speed."""

import argparse
import time
from dataclasses import replace

from sfd_hbm_ros.commands.arguments import (
    UsageError,
    add_harmonics,
    add_machine,
    harmonics_options,
    print_json,
    read_changed_machine,
    speed_from,
)
from sfd_hbm_ros.commands.files import check_outputs
from sfd_hbm_ros.commands.progress import Progress
from sfd_hbm_ros.commands.ranges import range_from, varied_from
from sfd_hbm_ros.commands.sweep_report import data_of, text_of
from sfd_hbm_ros.hbm.selection import SelectedBalance
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.response.curves.accuracy import balance_for_entry, balance_for_speeds
from sfd_hbm_ros.response.curves.curve import (
    ResponseCurve,
    parameter_curve,
    response_curve,
    selected_curve,
)
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.units import RPM


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument(
        "--rpm", required=True, metavar="A:B", help="speeds [rpm]; with --vary a single one"
    )
    parser.add_argument("--vary", metavar="PATH=A:B", help="vary an entry of the machine file")
    add_harmonics(parser)
    parser.add_argument(
        "--revolutions",
        type=int,
        default=1,
        metavar="N",
        help="revolutions in a period, 2 or 3 to let sub-harmonics in (default 1)",
    )
    parser.add_argument(
        "--select",
        type=float,
        metavar="TOLERANCE",
        help="use only the harmonics that matter: within this distance, of the clearance",
    )
    parser.add_argument(
        "--detached", action="store_true", help="look for branches that no run-up meets, too"
    )
    parser.add_argument("--output", metavar="F.csv", help="write the points as CSV, in arc order")
    parser.add_argument("--picture", metavar="F.png", help="draw the response curve")


def run(chosen: argparse.Namespace) -> None:
    """Follow the response and print what it shows."""
    check_outputs(chosen)
    started = time.perf_counter()
    summary = Summary(_curve(chosen))
    seconds = time.perf_counter() - started
    if chosen.output:
        from sfd_hbm_ros.report.table import write_table

        write_table(summary.curve, chosen.output)
    if chosen.picture:
        _draw(summary, chosen.picture)
    data = data_of(summary, seconds)
    if chosen.json:
        print_json(data)
    else:
        print(text_of(data, summary))
    if not summary.anywhere_stable:
        raise NoSolutionError(
            "no response in the range is stable: the machine can stay on none of those found"
        )


def _draw(summary: Summary, path: str) -> None:
    """The response of every damper above one another, with its jumps and peaks."""
    from sfd_hbm_ros.report.curves import draw_response  # matplotlib takes its time to import
    from sfd_hbm_ros.report.style import new_figure, save

    dampers = summary.curve.dampers
    figure, axes = new_figure(rows=len(dampers), size=(6.3, 3.7 * len(dampers)), share_x=True)
    for one, damper in zip(axes, dampers, strict=True):
        draw_response(one, summary.curve, damper, summary.jumps, summary.peaks)
        if len(dampers) > 1:
            one.set_title(damper)
    save(figure, path)


def _curve(chosen: argparse.Namespace) -> ResponseCurve:
    machine = read_changed_machine(chosen)
    options = harmonics_options(chosen.harmonics, chosen.revolutions)
    if chosen.vary is not None:
        for option in ("detached", "select"):
            if getattr(chosen, option):
                raise UsageError(f"--{option}: is for a range of speeds, not for --vary")
        return _over_parameter(chosen, machine, options)
    lowest, highest = sorted(range_from("--rpm", chosen.rpm))
    speeds = speed_from(lowest), speed_from(highest)
    with Progress(lambda n, speed: f"{n} points, {speed / RPM:.1f} rpm") as progress:
        balance = balance_for_speeds(machine, *speeds, options, progress)
        if chosen.select is None:
            curve = response_curve(balance, *speeds, progress=progress)
        else:
            selected = SelectedBalance(machine, balance.harmonics, chosen.select)
            curve = selected_curve(selected, *speeds, progress=progress)
        if chosen.detached:
            found = detached_branches(curve, *speeds, progress=progress)
            curve = replace(curve, detached=tuple(found))
        return curve


def _over_parameter(
    chosen: argparse.Namespace, machine: Machine, options: HarmonicsOptions
) -> ResponseCurve:
    path, start, end = varied_from(chosen.vary, machine)
    speed = speed_from(_number(chosen.rpm))
    with Progress(lambda n, value: f"{n} points, {path} = {value:.6g}") as progress:
        balance = balance_for_entry(machine, speed, path, (start, end), options, progress)
        return parameter_curve(balance, speed, path, start, end, progress=progress)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise UsageError(f"--rpm {text}: must be a single speed with --vary") from None
