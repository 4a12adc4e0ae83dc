"""The cases of the paper as data: curves, figures and claims, read from a YAML file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

from sfd_hbm_ros.machine import Machine, MachineError, override_all, read_machine
from sfd_hbm_ros.machine.document import read_document
from sfd_hbm_ros.machine.shipped import shipped
from sfd_hbm_ros.response.self_test import PublishedJumps, PublishedPeak

Range = tuple[float, float]
Kind = Literal["response", "orbit", "spectrum"]
Numbers = Mapping[str, Any]

_FILE = "paper_cases.yaml"


@dataclass(frozen=True)
class Case:
    """A response curve to compute.

    Attributes
    ----------
    machine : Machine
        The machine.
    harmonics : int
        The highest harmonic.
    speeds_rpm : (float, float)
        Range of the speed [rpm].
    closest : float
        Eccentricity at which the curve ends.
    detached_rpm : (float, float) or None
        Range in which detached branches are looked for [rpm].
    """

    machine: Machine
    harmonics: int
    speeds_rpm: Range
    closest: float
    detached_rpm: Range | None


@dataclass(frozen=True)
class Figure:
    """A figure of the paper.

    Attributes
    ----------
    title : str
        What it shows.
    kind : {"response", "orbit", "spectrum"}
        What is drawn.
    curves : mapping of str to str
        Names of the curves by their names in the legend.
    speeds_rpm : (float, float)
        Range of the speed of a response [rpm].
    rpm : float or None
        Speed of an orbit or a spectrum [rpm].
    """

    title: str
    kind: Kind
    curves: Mapping[str, str]
    speeds_rpm: Range
    rpm: float | None


@dataclass(frozen=True)
class Claim:
    """A claim of the paper: where it stands, its parts in words, its numbers, and its curves."""

    place: str
    curves: tuple[str, ...]
    says: Mapping[str, str]
    numbers: Numbers


@dataclass(frozen=True)
class Cases:
    """All of it; `agreement` and `criticals_rpm` are those of a `Study`."""

    curves: Mapping[str, Case]
    figures: Mapping[int, Figure]
    claims: Mapping[str, Claim]
    agreement: Numbers
    criticals_rpm: Range


def cases_file() -> Path:
    """The file of the cases.

    Raises
    ------
    FileNotFoundError
        If it is not installed beside the package.
    """
    return shipped(_FILE)


def read_cases(path: Path) -> Cases:
    """Read the cases; the machine's file lies beside theirs.

    Raises
    ------
    MachineError
        If a file cannot be read, or a change does not fit the machine.
    """
    data = read_document(path)
    machine = read_machine(path.parent / data["machine"])
    curves = {name: _case(machine, data, name) for name in data["curves"]}
    figures = {
        int(number): _figure(entry, data["speeds_rpm"])
        for number, entry in data["figures"].items()
    }
    claims = {
        name: Claim(
            entry["place"],
            tuple(entry["curves"]),
            entry["says"],
            _numbers(entry.get("numbers", {})),
        )
        for name, entry in data["claims"].items()
    }
    return Cases(
        curves, figures, claims, _numbers(data["agreement"]), _range(data["criticals_rpm"])
    )


def published_peak(cases: Cases) -> PublishedPeak:
    """The critical speed on the hardest spring, for the solver's self-test."""
    claim = cases.claims["P8"]
    return PublishedPeak(
        cases.curves[claim.curves[-1]].machine,
        cases.criticals_rpm,
        claim.numbers["rpm"],
        cases.agreement["speed"],
        f"the paper's {claim.place}",
    )


def published_jumps(cases: Cases) -> PublishedJumps:
    """The hysteresis with the larger unbalance on disk 2, for the solver's self-test."""
    claim = cases.claims["P2"]
    numbers, agreement = claim.numbers, cases.agreement
    return PublishedJumps(
        cases.curves[claim.curves[1]].machine,
        cases.criticals_rpm,
        (numbers["lowest_rpm"], numbers["highest_rpm"]),
        numbers["disk_2_rpm"],
        agreement["speed"],
        agreement["width"],
        f"the paper's {claim.place}",
    )


def _case(machine: Machine, data: Mapping[str, Any], name: str) -> Case:
    entry = data["curves"][name]
    try:
        changed = override_all(machine, _changes(data["curves"], name))
    except MachineError as error:
        raise MachineError(f"curves.{name}: {error}") from None
    return Case(
        changed,
        int(data["harmonics"]),
        _range(data["speeds_rpm"]),
        float(entry.get("closest", data["closest"])),
        _range(entry["detached_rpm"]) if "detached_rpm" in entry else None,
    )


def _changes(curves: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Changes of a curve, after those of the one that it is like."""
    entry = curves[name]
    changes = _changes(curves, entry["like"]) if "like" in entry else {}
    changes.update(entry["set"])
    return changes


def _figure(entry: Mapping[str, Any], speeds: list[str]) -> Figure:
    return Figure(
        entry["title"],
        cast(Kind, entry["kind"]),
        entry["curves"],
        _range(entry.get("speeds_rpm", speeds)),
        float(entry["rpm"]) if "rpm" in entry else None,
    )


def _numbers(entry: Mapping[str, Any]) -> Numbers:
    return {
        key: [float(item) for item in value] if isinstance(value, list) else float(value)
        for key, value in entry.items()
    }


def _range(pair: list[str]) -> Range:
    low, high = map(float, pair)
    return low, high
