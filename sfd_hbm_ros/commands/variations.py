"""What a study varies, given on the command line: PATH=A:B:N and PATH=DISTRIBUTION(...)."""

import re
from collections.abc import Iterable, Iterator

import numpy as np

from sfd_hbm_ros.commands.arguments import UsageError
from sfd_hbm_ros.commands.ranges import check_number, range_from
from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.study.design import MAX_VARIANTS
from sfd_hbm_ros.study.distributions import DISTRIBUTIONS, Distribution

_CALL = re.compile(r"(\w+)\(([^,()]+),([^,()]+)\)")


def grid_from(texts: Iterable[str], machine: Machine) -> dict[str, list[float]]:
    """Values of the entries of a grid, each given as PATH=A:B:N.

    Raises
    ------
    UsageError
        If a text has another form, a path stands twice, or the entry is not a number.
    MachineError
        If there is no such entry.
    """
    grid: dict[str, list[float]] = {}
    for path, text in _entries("--vary", texts, machine):
        ends, _, count = text.rpartition(":")
        if not (":" in ends and count.isdecimal() and 2 <= int(count) <= MAX_VARIANTS):
            raise UsageError(
                f"--vary {path}={text}: must be PATH=A:B:N with N values from A to B, 2 or more "
                f"and {MAX_VARIANTS} at most"
            )
        grid[path] = np.linspace(*range_from(f"--vary {path}", ends), int(count)).tolist()
    return grid


def scatter_from(texts: Iterable[str], machine: Machine) -> dict[str, Distribution]:
    """Distributions of the entries that are sampled, each given as PATH=NAME(NUMBER,NUMBER).

    Raises
    ------
    UsageError
        If a text has another form, a path stands twice, or the entry is not a number.
    MachineError
        If there is no such entry.
    """
    return {path: _distribution(path, text) for path, text in _entries("--sample", texts, machine)}


def _entries(option: str, texts: Iterable[str], machine: Machine) -> Iterator[tuple[str, str]]:
    """Path and the rest of each text; the paths are those of different numbers."""
    seen = set()
    for text in texts:
        path, _, rest = text.partition("=")
        check_number(machine, path)
        if path in seen:
            raise UsageError(f"{option} {path}: must be given once")
        seen.add(path)
        yield path, rest


def _distribution(path: str, text: str) -> Distribution:
    call = _CALL.fullmatch(text)
    if call is None or call[1] not in DISTRIBUTIONS:
        raise UsageError(
            f"--sample {path}={text}: must be PATH=normal(MEAN,SD), PATH=uniform(A,B) or "
            "PATH=lognormal(MEDIAN,S)"
        )
    try:
        return DISTRIBUTIONS[call[1]](_float(call[2]), _float(call[3]))
    except ValueError as error:
        raise UsageError(f"--sample {path}={text}: {error}") from None


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text.strip()} is not a number") from None
