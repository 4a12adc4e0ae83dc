"""Are the sweeps of random machines whole? Rotors on soft springs under gravity.

. scripts/environment.sh; python3 -m benchmarks.random_machines --machines 64

Each machine has one to four dampers whose centring springs may not carry it alone, so that its
films come near lock-up and its branches to 0.999 of the clearance. It is swept, and then asked
at other speeds by `solve`, from scratch and from the responses at the speeds beside. A sweep is
whole if every stable response that is found so lies on one of its branches, and if the machine
really jumps where it says so: beyond the point of a jump Newton's method finds no response that
goes on where the branch ended.
"""

import argparse
import contextlib
import io
import json
import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve, stability
from sfd_hbm_ros.machine import Machine, machine_from_dict, machine_to_dict
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.jumps import Direction, jumps
from sfd_hbm_ros.response.curves.place import solutions_at
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.responses import distance
from sfd_hbm_ros.units import RPM

HIGHEST = 5  # harmonic that is balanced
SPEEDS = 16  # at which each machine is asked
CLOSED = 0.9995  # eccentricity beyond which a response need not be on the curve
SAME = 1e-4  # of the clearance: that far from a branch a response lies on it
GRAVITY = 9.80665

_STEEL = {"youngs_modulus": 2.07e11, "density": 7833.0, "poisson_ratio": 0.3}
_TITANIUM = {"youngs_modulus": 1.14e11, "density": 4430.0, "poisson_ratio": 0.33}


@dataclass(frozen=True)
class Case:
    """A random machine and the range of speeds that it is swept over [rad/s]."""

    machine: Machine
    lowest: float
    highest: float


def random_case(seed: int, dampers: int | None = None) -> Case:
    """A rotor with two to four disks on one to four dampers, under gravity.

    Parameters
    ----------
    seed : int
        The same seed makes the same machine.
    dampers : int, optional
        Number of dampers, by default one to four in turn. A machine of one has a bearing, too.
    """
    rng = np.random.default_rng(seed)
    number = dampers or 1 + seed % 4
    elements = int(rng.integers(10, 19))
    outer = float(rng.uniform(0.04, 0.09))
    span = outer * float(rng.uniform(8.0, 14.0))
    cuts = np.sort(rng.choice(np.arange(1, elements), 2, replace=False))
    shaft = [
        {
            "elements": int(count),
            "length": span / elements,
            "outer_diameter": outer * float(rng.uniform(0.85, 1.15)),
            "inner_diameter": outer * float(rng.choice([0.0, 0.5])),
            "material": str(rng.choice(["steel", "steel", "titanium"])),
        }
        for count in np.diff([0, *cuts, elements])
    ]
    nodes = np.linspace(0, elements, max(number, 2)).round().astype(int)
    inner = np.setdiff1d(np.arange(1, elements), nodes)
    disks = []
    for i, node in enumerate(sorted(rng.choice(inner, int(rng.integers(2, 5)), replace=False))):
        mass = float(rng.uniform(2.0, 20.0)) * (outer / 0.065) ** 2
        polar = mass * (outer * float(rng.uniform(1.0, 2.0))) ** 2 / 2.0
        disk = {"mass": mass, "polar_inertia": polar, "diametral_inertia": polar / 2.0}
        disks.append({"name": f"disk_{i + 1}", "node": int(node), **disk})
    weight = GRAVITY * sum(disk["mass"] for disk in disks)
    housed = [
        _damper(rng, f"damper_{i + 1}", int(node), outer, weight / len(nodes))
        for i, node in enumerate(nodes[-number:])
    ]
    bearings = []
    if number == 1:
        kxx, kyy = rng.uniform(2e7, 2e8, 2)
        stiffness = [[float(kxx), 0.0], [0.0, float(kyy if rng.random() < 0.5 else kxx)]]
        bearings = [{"name": "bearing_1", "node": 0, "stiffness": stiffness, "damping": 100.0}]
    clearance = min(damper["clearance"] for damper in housed)
    heaviest = max(disks, key=lambda disk: disk["mass"])
    moment = heaviest["mass"] * clearance * float(10.0 ** rng.uniform(-1.3, -0.1))
    machine = machine_from_dict(
        {
            "materials": {"steel": _STEEL, "titanium": _TITANIUM},
            "shaft": shaft,
            "disks": disks,
            "bearings": bearings,
            "dampers": housed,
            "unbalance": [
                {
                    "station": heaviest["name"],
                    "magnitude": moment,
                    "phase": float(rng.uniform(-3.0, 3.0)),
                }
            ],
            "gravity": True,
        }
    )
    lowest = float(rng.uniform(1200.0, 2500.0))
    return Case(machine, lowest * RPM, lowest * float(rng.uniform(4.0, 7.0)) * RPM)


def _damper(
    rng: np.random.Generator, name: str, node: int, outer: float, weight: float
) -> dict[str, object]:
    """A damper whose spring lets its share of the weight [N] sag by 0.2 to 3 clearances."""
    clearance = outer * float(10.0 ** rng.uniform(-3.0, -2.5))
    diameter = outer * float(rng.uniform(1.4, 2.2))
    return {
        "name": name,
        "node": node,
        "bearing_stiffness": float(10.0 ** rng.uniform(7.8, 8.6)),
        "bearing_damping": 0.0,
        "journal_mass": float(rng.uniform(0.5, 3.0)),
        "centering_stiffness": weight / clearance / float(10.0 ** rng.uniform(-0.7, 0.5)),
        "diameter": diameter,
        "length": diameter * float(rng.uniform(0.2, 0.4)),
        "clearance": clearance,
        "viscosity": float(10.0 ** rng.uniform(-2.6, -1.6)),
        "density": 870.0,
        "film": {"model": "short", "cavitation": True, "inertia": bool(rng.random() < 0.7)},
    }


@dataclass
class Verdict:
    """What a machine's sweep was worth.

    Attributes
    ----------
    seconds : float
        Processor time of the sweep [s].
    points, branches : int
        Their numbers.
    ends : list of str
        Why the branches ended.
    failure : str
        Why there is no curve; empty if there is one.
    asked : int
        Stable responses that `solve` found.
    missing : list of (float, float)
        Speed [rpm] and eccentricity of those that no branch has.
    spurious : list of float
        Speeds [rpm] of jumps beyond which the branch goes on.
    """

    seconds: float = 0.0
    points: int = 0
    branches: int = 0
    ends: list[str] = field(default_factory=list)
    failure: str = ""
    asked: int = 0
    missing: list[tuple[float, float]] = field(default_factory=list)
    spurious: list[float] = field(default_factory=list)

    @property
    def whole(self) -> bool:
        """Whether nothing was missing and nothing spurious."""
        return not (self.missing or self.spurious or (self.failure and self.asked))


def judge(case: Case, highest: int = HIGHEST, speeds: int = SPEEDS) -> Verdict:
    """Sweep a machine, and look for stable responses that its curve does not have."""
    balance = HarmonicBalance(case.machine, Harmonics(highest))
    verdict = Verdict()
    started = time.process_time()
    curve = None
    try:
        curve = response_curve(balance, case.lowest, case.highest)
    except (NoSolutionError, ArithmeticError) as error:
        verdict.failure = str(error)
    verdict.seconds = time.process_time() - started
    for solution in stable_responses(balance, case, speeds):
        verdict.asked += 1
        if curve is None or not _has(curve, solution):
            verdict.missing.append((solution.speed / RPM, solution.eccentricity_max))
    if curve is not None:
        verdict.points = sum(len(branch.values) for branch in curve.branches)
        verdict.branches = len(curve.branches)
        verdict.ends = [branch.stop.name for branch in curve.branches]
        verdict.spurious = list(_spurious(curve))
    return verdict


def stable_responses(balance: HarmonicBalance, case: Case, speeds: int) -> Iterator[Solution]:
    """Stable responses at speeds over the range, from scratch and from those beside, each once."""
    grid = np.linspace(case.lowest, case.highest, speeds + 1)[:-1] + 0.37 * (
        (case.highest - case.lowest) / speeds
    )
    at: dict[float, list[Solution]] = {speed: [] for speed in grid.tolist()}
    for order in (list(at), list(at)[::-1]):
        before: list[Solution] = []
        for speed in order:
            for start in (None, *before):
                found = solve(balance, speed, start)
                if not found.converged or found.eccentricity_max > CLOSED:
                    continue
                if all(distance(found, other) > SAME for other in at[speed]):
                    at[speed].append(found)
            before = at[speed]
    for found in (one for several in at.values() for one in several):
        if stability(balance, found).stable:
            yield found


def _has(curve: ResponseCurve, solution: Solution) -> bool:
    """Whether a response lies on a branch of the curve."""
    return any(
        distance(other, solution) < SAME
        for branch in curve.branches
        if branch.periodic
        for _, other in solutions_at(branch, solution.speed)
    )


def _spurious(curve: ResponseCurve) -> Iterator[float]:
    """Speeds [rpm] of jumps that a machine would not make, as its branch goes on."""
    balance, nudge = curve.balance, 1e-4
    for direction in Direction:
        sign = 1.0 if direction is Direction.RUN_UP else -1.0
        for jump in jumps(curve, direction):
            before = jump.before
            if not isinstance(before, Solution) or before.eccentricity_max > CLOSED:
                continue
            beyond = solve(balance, before.speed * (1.0 + sign * nudge), before)
            gone_on = beyond.converged and distance(beyond, before) < 0.02
            if gone_on and stability(balance, beyond).stable:
                yield jump.value / RPM


def main() -> None:
    """Judge machines, a line each, and sum up."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--machines", type=int, default=64)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--highest", type=int, default=HIGHEST, help="highest harmonic")
    parser.add_argument("--save", type=Path, help="folder for machines whose sweep is not whole")
    chosen = parser.parse_args()
    verdicts = []
    for seed in range(chosen.first, chosen.first + chosen.machines):
        case = random_case(seed)
        with contextlib.redirect_stderr(io.StringIO()), np.errstate(all="ignore"):
            verdict = judge(case, chosen.highest)
        verdicts.append(verdict)
        words = "whole" if verdict.whole else "NOT WHOLE"
        print(
            f"{seed:4d} {len(case.machine.dampers)} dampers, {case.lowest / RPM:.0f}:"
            f"{case.highest / RPM:.0f} rpm: {words}, {verdict.points} points, "
            f"{verdict.seconds:.1f} s, {' '.join(verdict.ends)} {verdict.failure}",
            *(f"missing {rpm:.0f} rpm e {e:.4f}" for rpm, e in verdict.missing),
            *(f"spurious jump {rpm:.1f} rpm" for rpm in verdict.spurious),
            sep="; ",
            flush=True,
        )
        if chosen.save and not verdict.whole:
            text = json.dumps(machine_to_dict(case.machine))
            (chosen.save / f"machine_{seed}.json").write_text(text, encoding="utf-8")
    whole = sum(verdict.whole for verdict in verdicts)
    answered = [verdict for verdict in verdicts if verdict.asked]
    seconds = [verdict.seconds for verdict in answered] or [0.0]
    print(
        f"\n{whole} of {len(verdicts)} sweeps are whole ({len(answered)} machines have a stable "
        f"response); processor time {statistics.median(seconds):.1f} s in the median, "
        f"{max(seconds):.1f} s at most"
    )


if __name__ == "__main__":
    main()
