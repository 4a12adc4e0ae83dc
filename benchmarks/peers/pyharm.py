"""pyHarm's side: the paper's rotor with our film as its element; runs in pyHarm's environment."""

import statistics
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pyHarm import Maestro
from pyHarm.Elements.NodeToNodeElements.NodeToNodeElement import NodeToNodeElement

from benchmarks.peers.exchange import answer
from benchmarks.peers.problem import PAPER, seconds
from sfd_hbm_ros.film import FilmForces, film_of
from sfd_hbm_ros.rotor import RotorModel, assemble

Array = NDArray[np.float64]


class FilmElement(NodeToNodeElement):  # type: ignore[misc]  # pyHarm is not typed
    """The paper's film between a journal and the ground, by alternating frequency and time."""

    factory_keyword = "Film"

    def __post_init__(self) -> None:
        self.film = film_of(PAPER.dampers[0])
        self.length, self.frequency = 1.0, 1.0

    def __flag_update__(self) -> None:
        self.flag_nonlinear = self.flag_AFT = True

    def adim(self, lc: float, wc: float) -> None:
        """Take lengths in units of lc [m] and frequencies in units of wc [rad/s]."""
        self.length, self.frequency, self.flag_adim = lc, wc, True

    def evalResidual(self, xg: Array, om: float) -> Array:
        """Minus the film's force in the harmonics [N]."""
        _, _, film = self._linearise(xg, om)
        self.R = -self._joined(film.force.T @ self.D["tf"])
        return self.R

    def evalJacobian(self, xg: Array, om: float) -> tuple[Array, Array]:
        """Derivatives of the residual by the unknowns and by the frequency."""
        bases, coefficients, film = self._linearise(xg, om)
        self.J = np.zeros((self.indices.size,) * 2)
        slopes = (film.by_position, film.by_velocity, film.by_acceleration)
        for i, j in np.ndindex(2, 2):
            sampled = sum(basis * one[:, i, j] for basis, one in zip(bases, slopes, strict=True))
            block = self.length * (sampled @ self.D["tf"]).T
            self.J -= self.Pdir[i].T @ block @ self.Pdir[j]
        _, first, second = (coefficients @ basis for basis in bases)
        change = np.einsum("tij,jt->it", film.by_velocity, self.length * first)
        change += np.einsum("tij,jt->it", film.by_acceleration, 2.0 * self.length * second)
        self.dJdom = -self._joined(change @ self.D["tf"]) / om
        return self.J, self.dJdom

    def _linearise(self, xg: Array, om: float) -> tuple[list[Array], Array, FilmForces]:
        """Bases (harmonics, samples) of the motion and its rates, coefficients and film."""
        coefficients = np.array([direction @ xg[self.indices] for direction in self.Pdir])
        rate = self.frequency * om * self.nabla.T
        bases = [self.D["ft"], rate @ self.D["ft"], rate @ rate @ self.D["ft"]]
        states = (np.ascontiguousarray((self.length * coefficients @ b).T) for b in bases)
        return bases, coefficients, self.film.linearise(*states)

    def _joined(self, coefficients: Array) -> Array:
        """Both directions' coefficients as the element's vector."""
        joined: Array = self.Pdir[0].T @ coefficients[0] + self.Pdir[1].T @ coefficients[1]
        return joined


def system(model: RotorModel, harmonics: int, samples: int, unit: float) -> dict[str, Any]:
    """The rotor, unbalance and film as pyHarm's input; every two coordinates are a node."""
    matrices = {"M": model.M, "C": model.C, "G": model.G, "K": model.K}
    connectors: dict[str, Any] = {
        "film": {"type": "Film", "connect": {"rotor": [model.size // 2 - 1]}, "dirs": [0, 1]}
    }
    for coordinate in np.flatnonzero(model.unbalance):
        amplitude = model.unbalance[coordinate]  # times W^2; pyHarm differentiates twice
        connectors[f"unbalance {coordinate}"] = {
            "type": "GOForcing",
            "connect": {"rotor": [int(coordinate) // 2]},
            "dirs": [int(coordinate) % 2],
            "dto": 2,
            "ho": 1,
            "amp": -abs(amplitude),
            "phi": -float(np.angle(amplitude)),
        }
    scales = {"status": True, "lc": PAPER.dampers[0].clearance, "wc": unit}
    return {
        "system": {"type": "Base", "nh": harmonics, "nti": samples, "adim": scales},
        "substructures": {"rotor": {"matrix": matrices, "ndofs": 2}},
        "connectors": connectors,
        "plugin": [FilmElement],
    }


def follow(
    harmonics: int,
    samples: int,
    start: list[float],
    speed: float,
    step: float,
    points: int,
    residual: float,
) -> dict[str, Any]:
    """Follow the branch from a converged start [m], over steps in the speed [rad/s].

    `residual` is the norm that ends the iterations [N]. The first point is not timed.
    """
    unit = step  # so that one step has the length 1
    study = {
        "study": "frf",
        "solver": "NewtonRaphson",
        "solver_options": {"tol_residual": residual, "tol_delta_x": np.inf},
        "corrector": "pseudo_arc_length",
        "predictor_options": {"norm": "om"},
        "puls_inf": speed,
        "puls_sup": speed + 100.0 * step,
        "ds0": 1.0,
        "ds_max": 1.0,
        "verbose": False,
    }
    model = assemble(PAPER)
    problem = system(model, harmonics, samples, unit) | {"analysis": {"branch": study}}
    analysis = Maestro(problem).nls["branch"]
    clearance = PAPER.dampers[0].clearance
    analysis.initialise(np.array(start) / clearance)
    times = [seconds(analysis.makeStep) for _ in range(points + 1)][1:]
    found = [one for one in analysis.SolList[2:] if one.flag_accepted]
    journal = np.array([one.x[:-1].reshape(-1, model.size)[:, -2:] for one in found])
    return {
        "seconds": statistics.median(times),
        "speeds": [float(one.x[-1]) * unit for one in found],
        "journal": (clearance * journal).tolist(),
        "iterations": float(np.mean([one.iter_numb for one in found])),
    }


if __name__ == "__main__":
    answer(follow)
