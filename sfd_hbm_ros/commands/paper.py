"""The reference paper: its figures computed again, and its claims beside what was found."""

import argparse
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sfd_hbm_ros.commands.arguments import add_json, print_json
from sfd_hbm_ros.commands.files import check_figures
from sfd_hbm_ros.commands.progress import Progress
from sfd_hbm_ros.report.paper.cases import Cases, cases_file, read_cases
from sfd_hbm_ros.report.paper.claims import JudgedClaim, judge
from sfd_hbm_ros.report.paper.compute import compute
from sfd_hbm_ros.report.paper.judging import Verdict
from sfd_hbm_ros.report.paper.study import Study
from sfd_hbm_ros.response.curves.curve import ResponseCurve

_WIDTH = 99


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("--figures", type=Path, metavar="DIR", help="draw Figs. 4 to 19 there")
    add_json(parser)


def run(chosen: argparse.Namespace) -> None:
    """Compute the paper's curves, judge its claims, and draw its figures."""
    if chosen.figures:
        check_figures(chosen.figures)
    started = time.perf_counter()
    cases = read_cases(cases_file())
    computed: dict[str, ResponseCurve] = {}
    with Progress(lambda n, _: f"{n} of {len(cases.curves)} curves") as progress:
        for name, curve in compute(cases, cases.curves):
            computed[name] = curve
            progress(len(computed))
        study = Study(computed, cases.agreement, cases.criticals_rpm)
        claims = list(judge(cases, study))
        figures = _draw(cases, study, chosen.figures) if chosen.figures else []
    seconds = time.perf_counter() - started
    if chosen.json:
        print_json(_data(claims, figures, seconds))
    else:
        print(_text(claims))
        print(f"\n{len(computed)} curves in {seconds:.0f} s")


def _draw(cases: Cases, study: Study, folder: Path) -> list[Path]:
    from sfd_hbm_ros.report.paper.pictures import draw_figures  # matplotlib takes its time

    return draw_figures(cases, study, folder)


def _data(claims: Sequence[JudgedClaim], figures: Sequence[Path], seconds: float) -> Any:
    return {
        "claims": [
            {
                "claim": one.name,
                "place": one.claim.place,
                "verdict": one.verdict.value,
                "parts": [
                    {
                        "paper": one.claim.says[key],
                        "ours": part.ours,
                        "verdict": part.verdict.value,
                        "why": part.why,
                    }
                    for key, part in one.parts.items()
                ],
            }
            for one in claims
        ],
        "figures": [str(path) for path in figures],
        "seconds": seconds,
    }


def _text(claims: Sequence[JudgedClaim]) -> str:
    """The same for people: every part of a claim, ours below it, and a count at the end."""
    lines = ["The rotor is a reconstruction: the paper's Fig. 3 gives no dimensions.", ""]
    for one in claims:
        lines.append(f"{one.name}, {one.claim.place}: {one.verdict.value}")
        for key, part in one.parts.items():
            lines += _wrapped(f"  {part.verdict.value:<15} ", one.claim.says[key])
            lines += _wrapped(f"  {'':15}   ours: ", part.ours)
            if part.why:
                lines += _wrapped(f"  {'':15}   why:  ", part.why)
    counts = [
        f"{sum(one.verdict is verdict for one in claims)} {verdict.value}" for verdict in Verdict
    ]
    parts = [part for one in claims for part in one.parts.values()]
    held = sum(part.verdict is Verdict.HOLDS for part in parts)
    return "\n".join([*lines, "", f"{', '.join(counts)}; of their {len(parts)} parts {held} hold"])


def _wrapped(head: str, text: str) -> list[str]:
    """A text behind a head, its further lines below its first."""
    return textwrap.wrap(
        text,
        _WIDTH,
        initial_indent=head,
        subsequent_indent=" " * len(head),
        break_on_hyphens=False,
    )
