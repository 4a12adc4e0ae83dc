"""Response curves of many variants of a machine: grids and Monte Carlo, on all cores.

Every outcome is kept in a journal beside the output as soon as it is there.
"""

import argparse
import time
from functools import partial
from pathlib import Path
from typing import Any

from sfd_hbm_ros import __version__
from sfd_hbm_ros.commands.arguments import (
    UsageError,
    add_harmonics,
    add_machine,
    harmonics_options,
    print_json,
    read_changed_machine,
    speed_from,
    warn,
)
from sfd_hbm_ros.commands.files import check_outputs
from sfd_hbm_ros.commands.progress import Progress, share_bar
from sfd_hbm_ros.commands.ranges import range_from
from sfd_hbm_ros.commands.study_report import data_of, text_of
from sfd_hbm_ros.commands.variations import grid_from, scatter_from
from sfd_hbm_ros.machine import Machine, machine_to_dict
from sfd_hbm_ros.report.study_table import study_writer
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.study.cluster import on_cluster
from sfd_hbm_ros.study.complete import Computer, complete
from sfd_hbm_ros.study.design import Design, check_variants
from sfd_hbm_ros.study.journal import Journal
from sfd_hbm_ros.study.processes import on_processes
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.study.task import Task


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    add_machine(parser)
    parser.add_argument("--rpm", required=True, metavar="A:B", help="speeds of each curve [rpm]")
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=A:B:N",
        help="give an entry N values from A to B; several make a grid",
    )
    parser.add_argument(
        "--sample",
        action="append",
        default=[],
        metavar="PATH=DISTRIBUTION",
        help="draw an entry from 'normal(MEAN,SD)', 'uniform(A,B)' or 'lognormal(MEDIAN,S)', S "
        "the standard deviation of the natural logarithm; at each point of a grid the same draws",
    )
    parser.add_argument(
        "--samples", type=int, metavar="N", help="number of draws (needed with --sample)"
    )
    parser.add_argument("--seed", type=int, metavar="S", help="seed of the draws (default 0)")
    parser.add_argument(
        "--at",
        type=float,
        metavar="RPM",
        help="operating speed: how many responses there are, and the worst and best vibration",
    )
    parser.add_argument(
        "--detached",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="look for branches that no run-up meets, too (default: yes)",
    )
    add_harmonics(parser)
    parser.add_argument(
        "--output",
        type=Path,
        required=True,
        metavar="F.csv",
        help="write one row a variant, as Parquet where it ends in .parquet. F.csv.journal keeps "
        "what has been computed: after an interruption the same command goes on",
    )
    parser.add_argument(
        "--picture", type=Path, metavar="F.png", help="draw the probability of a jump over speed"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="compute on the Dask cluster of this scheduler"
    )


def run(chosen: argparse.Namespace) -> None:
    """Compute what the journal does not hold yet, and write it all."""
    started = time.perf_counter()
    chosen.journal = Path(f"{chosen.output}.journal")
    check_outputs(chosen, (".csv", ".parquet"))
    machine = read_changed_machine(chosen)
    design, task = _study(chosen, machine)
    check_variants(design, machine)
    write = study_writer(chosen.output)
    with Journal(chosen.journal, _identity(chosen, task)) as journal:
        kept = len(journal.outcomes)
        if journal.damaged:
            warn([f"{journal.path}: {journal.damaged} damaged lines are computed again"])
        with Progress(share_bar(kept, len(design), "variants")) as progress:
            results = complete(journal, design, _computer(task, chosen.scheduler), progress)
    write(results)
    if not results.solved.any():
        raise NoSolutionError(
            f"none of the {len(design)} variants has a solution; variant 0: "
            f"{results.outcomes[0].reason}"
        )
    if chosen.picture:
        _draw(results, task, chosen.picture)
    data = data_of(results, kept, time.perf_counter() - started, chosen.at)
    if chosen.json:
        print_json(data)
    else:
        print(text_of(data))


def _study(chosen: argparse.Namespace, machine: Machine) -> tuple[Design, Task]:
    if bool(chosen.sample) != (chosen.samples is not None):
        raise UsageError("--sample and --samples: must be given together")
    if chosen.seed is not None and not chosen.sample:
        raise UsageError(f"--seed {chosen.seed}: is for --sample")
    if chosen.samples is not None and chosen.samples < 1:
        raise UsageError(f"--samples {chosen.samples}: must be at least 1")
    if chosen.seed is not None and chosen.seed < 0:
        raise UsageError(f"--seed {chosen.seed}: must be at least 0")
    design = Design(
        grid_from(chosen.vary, machine),
        scatter_from(chosen.sample, machine),
        chosen.samples or 1,
        chosen.seed or 0,
    )
    lowest, highest = map(speed_from, sorted(range_from("--rpm", chosen.rpm)))
    operating = None if chosen.at is None else speed_from(chosen.at, "--at")
    if operating is not None and not lowest <= operating <= highest:
        raise UsageError(f"--at {chosen.at:g}: must lie in the range of --rpm {chosen.rpm}")
    harmonics = harmonics_options(chosen.harmonics)
    return design, Task(
        machine, design.paths, lowest, highest, harmonics, operating, chosen.detached
    )


def _identity(chosen: argparse.Namespace, task: Task) -> dict[str, Any]:
    """All that the outcomes depend on."""
    return {
        "version": __version__,
        "machine": machine_to_dict(task.machine),
        "rpm": sorted(range_from("--rpm", chosen.rpm)),
        "vary": chosen.vary,
        "sample": chosen.sample,
        "samples": chosen.samples,
        "seed": chosen.seed or 0,
        "harmonics": chosen.harmonics,
        "at": chosen.at,
        "detached": chosen.detached,
    }


def _computer(task: Task, scheduler: str | None) -> Computer:
    if scheduler is None:
        return partial(on_processes, task)
    return partial(on_cluster, task, address=scheduler)


def _draw(results: Results, task: Task, path: Path) -> None:
    from sfd_hbm_ros.report.probability import draw_probability  # matplotlib takes its time
    from sfd_hbm_ros.report.style import new_figure, save

    figure, [axes] = new_figure()
    draw_probability(axes, results, task.lowest, task.highest)
    save(figure, path)
