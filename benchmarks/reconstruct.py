"""How well config/paper_rotor.yaml fits the reference paper, and whether one near it fits better.

Without gravity rotor and film are axisymmetric, and the response is a circular orbit about the
centre. Its radius e c obeys one equation, |D(W) e c - f(e, W)| = |F(W)|, with the rotor's
condensed stiffness D and force F at 1x and the film's force f on the circle. All of its roots are
found on a grid of speeds and eccentricities, for every candidate, and compared with what the
paper reports:

    python3 benchmarks/reconstruct.py
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.machine import Machine, override_all, read_machine
from sfd_hbm_ros.rotor import Condensation, assemble
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]

LBF_PER_INCH = 4.4482216152605 / 0.0254  # [N/m]
SPEEDS = np.arange(3700.0, 4250.0, 5.0)  # [rpm]
ECCENTRICITIES = np.linspace(0.02, 0.995, 400)
BELOW = 0.85  # eccentricity above which detached branches lie

DIAMETERS = (0.0316, 0.03175, 0.0318, 0.0319, 0.0320, 0.0321)  # [m]
NODES = ((9, 12, 15), (10, 12, 14), (11, 12, 13), (10, 12, 15), (9, 12, 14))
MASSES = (0.5, 1.5, 3.0)  # [kg]
SPRINGS = (12_500.0, 15_000.0, 17_500.0, 20_000.0)  # [lbf/in]

SMALL, LARGE = 4.319e-4, 5.039e-4  # unbalances of Figs. 4 and 5 to 7 [kg m]
WIDTHS = 97.0, 180.0, 110.0  # of the hysteresis with the large one on disks 1, 2, 3 [rpm]
PEAK = 3790.0  # critical speed on 10 000 lbf/in with the small one on disk 2 [rpm]


@dataclass(frozen=True)
class Fit:
    """What a candidate gives beside the paper's numbers.

    Attributes
    ----------
    small : (3,) tuple of float
        Width over which the small unbalance on disks 1 to 3 has several responses, detached ones
        left out [rpm]; the paper reports none.
    main, whole : (3,) tuple of float
        The same for the large one, on the branch that a run-up meets and with detached ones.
    peak : float
        Critical speed on 10 000 lbf/in [rpm].
    """

    small: tuple[float, ...]
    main: tuple[float, ...]
    whole: tuple[float, ...]
    peak: float

    def misfit(self, widths: tuple[float, ...]) -> float:
        """Root mean square of the deviations, in units of 10 rpm."""
        off = [*self.small, *np.subtract(widths, WIDTHS), self.peak - PEAK]
        return float(np.sqrt(np.mean(np.square(off)))) / 10.0


def film_forces(machine: Machine) -> NDArray[np.complex128]:
    """Force of the film on circles [N], seen from the journal, (speeds, eccentricities)."""
    film = film_of(machine.dampers[0])
    w, radius = np.meshgrid(SPEEDS * RPM, ECCENTRICITIES * film.clearance, indexing="ij")
    nothing = np.zeros(w.size)
    position = np.stack([radius.ravel(), nothing], axis=-1)
    velocity = np.stack([nothing, (w * radius).ravel()], axis=-1)
    acceleration = np.stack([(-w * w * radius).ravel(), nothing], axis=-1)
    force = film.force(position, velocity, acceleration)
    return (force[:, 0] + 1j * force[:, 1]).reshape(len(SPEEDS), -1)


def imbalance(machine: Machine, film: NDArray[np.complex128]) -> Array:
    """|D e c - f| - |F| on the grid [N]; the responses are its zeros."""
    condensation = Condensation(assemble(machine))
    rotor = [condensation.at(rpm * RPM, [1.0]) for rpm in SPEEDS]
    stiffness = np.array([one.stiffness[0, 0, 0] - 1j * one.stiffness[0, 0, 1] for one in rotor])
    force = np.array([abs(one.force[0, 0]) for one in rotor])
    radius = ECCENTRICITIES * machine.dampers[0].clearance
    lacking: Array = np.abs(np.outer(stiffness, radius) - film) - force[:, np.newaxis]
    return lacking


def widths_of(lacking: Array) -> tuple[float, float]:
    """Width with several responses on the first stretch of speeds, and on all [rpm]."""
    several = np.diff(np.sign(lacking), axis=1).astype(bool).sum(axis=1) > 1
    step = SPEEDS[1] - SPEEDS[0]
    starts = np.flatnonzero(np.diff(np.concatenate([[0], several.astype(int)])) == 1)
    if not starts.size:
        return 0.0, 0.0
    rest = several[starts[0] :]
    first = len(rest) if rest.all() else int(np.argmin(rest))
    return float(step * first), float(step * several.sum())


def peak_of(lacking: Array) -> float:
    """Speed of the greatest response that is not detached [rpm]."""
    changes = np.diff(np.sign(lacking), axis=1) != 0
    changes &= ECCENTRICITIES[1:] < BELOW
    greatest = np.where(changes, ECCENTRICITIES[1:], 0.0).max(axis=1)
    return float(SPEEDS[np.argmax(greatest)])


def fit(machine: Machine, film: NDArray[np.complex128]) -> Fit:
    """Compare one rotor with the paper."""

    def unbalanced(magnitude: float, disk: int) -> dict[str, object]:
        return {"unbalance": [{"station": f"disk_{disk}", "magnitude": magnitude}]}

    small, large = (
        [imbalance(override_all(machine, unbalanced(magnitude, disk)), film) for disk in (1, 2, 3)]
        for magnitude in (SMALL, LARGE)
    )
    widths = [widths_of(lacking) for lacking in large]
    softer = {"dampers.damper_1.centering_stiffness": 1e4 * LBF_PER_INCH} | unbalanced(SMALL, 2)
    return Fit(
        tuple(widths_of(lacking[:, ECCENTRICITIES < BELOW])[1] for lacking in small),
        tuple(main for main, _ in widths),
        tuple(whole for _, whole in widths),
        peak_of(imbalance(override_all(machine, softer), film)),
    )


def candidates() -> Iterator[tuple[str, dict[str, object]]]:
    """Rotors to try: a line about each, and its changes."""
    for diameter, nodes, mass, spring in itertools.product(DIAMETERS, NODES, MASSES, SPRINGS):
        changes: dict[str, object] = {
            f"disks.disk_{i}.node": node for i, node in enumerate(nodes, start=1)
        }
        changes["shaft.0.outer_diameter"] = diameter
        changes["dampers.damper_1.journal_mass"] = mass
        changes["dampers.damper_1.centering_stiffness"] = spring * LBF_PER_INCH
        line = f"{1e3 * diameter:6.2f} mm  {'-'.join(map(str, nodes)):>8}  {mass:3.1f} kg"
        yield f"{line}  {spring:6.0f} lbf/in", changes


def line_of(name: str, found: Fit) -> str:
    """One row of the table."""
    columns = [" ".join(f"{w:4.0f}" for w in ws) for ws in (found.small, found.main, found.whole)]
    misfits = f"{found.misfit(found.main):5.2f} {found.misfit(found.whole):5.2f}"
    return f"{name:<42}{'   '.join(columns)}   {found.peak:6.0f}   {misfits}"


def main() -> None:
    """Print the present rotor, and the best by either reading of the paper's widths."""
    machine = read_machine(Path(__file__).parents[1] / "config" / "paper_rotor.yaml")
    film = film_forces(machine)
    print("Widths of hysteresis for disks 1, 2, 3 [rpm], critical speed [rpm] on 10 000 lbf/in,")
    print("and the misfit [10 rpm] with detached branches left out and put in.")
    head = (
        f"{'431.9 g mm':>14}   {'503.9 g mm':>14}   {'with detached':>14}   {'peak':>6}   misfit"
    )
    print(f"{'':42}{head}")
    print(f"{'the paper':<42}{'0    0    0':>14}     97  180  110{'':>20}   {PEAK:.0f}")
    print(line_of("config/paper_rotor.yaml", fit(machine, film)))
    fits = [(name, fit(override_all(machine, change), film)) for name, change in candidates()]
    for title, key in (
        ("Best with detached branches left out:", lambda one: one[1].misfit(one[1].main)),
        ("Best with them put in:", lambda one: one[1].misfit(one[1].whole)),
    ):
        print(f"\n{title}")
        for name, found in sorted(fits, key=key)[:8]:
            print(line_of(name, found))


if __name__ == "__main__":
    main()
