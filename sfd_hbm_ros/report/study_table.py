"""The variants of a study as a table of numbers."""

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from sfd_hbm_ros.report.csv_file import write_csv
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.study.task import Outcome
from sfd_hbm_ros.units import RPM

_OUTCOMES: dict[str, Callable[[Outcome], Any]] = {
    "run_up_rpm": lambda one: _rpm(one.run_up),
    "coast_down_rpm": lambda one: _rpm(one.coast_down),
    "width_rpm": lambda one: _rpm(one.width),
    "peak_rpm": lambda one: _rpm(one.peak_speed),
    "peak_eccentricity": lambda one: one.peak_eccentricity,
    "seconds": lambda one: one.seconds,
    "reason": lambda one: one.reason,
    "peak_vibration": lambda one: one.peak_vibration,
    "several_from_rpm": lambda one: _rpm(one.several_from),
    "several_to_rpm": lambda one: _rpm(one.several_to),
    "detached": lambda one: one.detached,
    "locked_up": lambda one: None if one.locked_up is None else int(one.locked_up),
    "responses": lambda one: one.responses,
    "worst_vibration": lambda one: one.worst_vibration,
    "best_vibration": lambda one: one.best_vibration,
    "worst_eccentricity": lambda one: one.worst_eccentricity,
    "best_eccentricity": lambda one: one.best_eccentricity,
}


def study_writer(path: Path) -> Callable[[Results], None]:
    """Return what writes a study to a file: one row a variant, in the order of their numbers.

    Columns are the number of the variant, the values of the entries that vary by their dotted
    paths, the speeds of the first jumps of a run-up and of a coast-down [rpm], the width between
    them [rpm], speed [rpm] and eccentricity of the peak, the time taken [s], and the reason where
    there is no solution; then what is said in `Outcome` of several responses, with speeds in rpm
    and 1 or 0 for what is so or not. What there is not is left empty. Numbers are in full
    precision.

    Parameters
    ----------
    path : Path
        The file: Parquet where it ends in .parquet, else CSV. The writer raises OSError if it
        cannot be written.

    Raises
    ------
    ModuleNotFoundError
        If it shall be Parquet, and pyarrow is not installed.
    """
    if path.suffix != ".parquet":
        return lambda results: _write_csv(_columns(results), path)
    try:
        arrow = importlib.import_module("pyarrow")
        parquet = importlib.import_module("pyarrow.parquet")
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            f"{path}: Parquet needs pyarrow, which is not installed; the name of a CSV file must "
            "not end in .parquet"
        ) from None
    return lambda results: parquet.write_table(arrow.table(_columns(results)), path)


def _write_csv(columns: dict[str, list[Any]], path: Path) -> None:
    write_csv(path, columns, zip(*columns.values(), strict=True))


def _columns(results: Results) -> dict[str, list[Any]]:
    design, outcomes = results.design, results.outcomes
    values = zip(design.paths, design.values.T.tolist(), strict=True)
    return {
        "variant": list(range(len(outcomes))),
        **dict(values),
        **{name: [read(one) for one in outcomes] for name, read in _OUTCOMES.items()},
    }


def _rpm(speed: float | None) -> float | None:
    return None if speed is None else speed / RPM
