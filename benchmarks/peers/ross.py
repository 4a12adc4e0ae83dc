"""ROSS's side: the paper's rotor, with our film by callback; runs in ROSS's environment."""

from typing import Any

import numpy as np
import ross
from numpy.typing import NDArray

from benchmarks.peers.exchange import answer
from benchmarks.peers.problem import PAPER, seconds
from sfd_hbm_ros.film import film_of

Array = NDArray[np.float64]

JOURNAL = PAPER.nodes  # node that ROSS gives to the damper's journal


def rotor() -> Any:
    """The paper's rotor; the journal is a mass between ball bearing and centring spring."""
    (segment,), (damper,), (bearing,) = PAPER.shaft, PAPER.dampers, PAPER.bearings
    steel = segment.material
    material = ross.Material(
        name="steel", rho=steel.density, E=steel.youngs_modulus, Poisson=steel.poisson_ratio
    )
    shaft = [
        ross.ShaftElement(
            L=segment.length,
            idl=segment.inner_diameter,
            odl=segment.outer_diameter,
            material=material,
        )
        for _ in range(segment.elements)
    ]
    disks = [
        ross.DiskElement(n=one.node, m=one.mass, Id=one.diametral_inertia, Ip=one.polar_inertia)
        for one in PAPER.disks
    ]
    bearings = [
        ross.BearingElement(n=bearing.node, kxx=float(bearing.stiffness[0][0]), cxx=0.0),
        ross.BearingElement(n=damper.node, n_link=JOURNAL, kxx=damper.bearing_stiffness, cxx=0.0),
        ross.BearingElement(n=JOURNAL, kxx=damper.centering_stiffness, cxx=0.0),
    ]
    return ross.Rotor(shaft, disks, bearings, [ross.PointMass(n=JOURNAL, m=damper.journal_mass)])


def steady_state(machine: Any, speed: float, revolutions: int, steps: int) -> dict[str, Any]:
    """Integrate from rest by Newmark's method.

    Returns the processor time [s], and the greatest eccentricity in each revolution.
    """
    film, clearance = film_of(PAPER.dampers[0]), PAPER.dampers[0].clearance
    dofs = machine.number_dof
    journal = slice(dofs * JOURNAL, dofs * JOURNAL + 2)
    time = np.arange(revolutions * steps + 1) * (2.0 * np.pi / speed / steps)
    force = np.zeros((time.size, machine.ndof))
    for one in PAPER.unbalance:
        first = dofs * PAPER.stations[one.station]
        angle = speed * time + one.phase
        push = one.magnitude * speed**2
        force[:, first : first + 2] += push * np.column_stack([np.cos(angle), np.sin(angle)])

    def with_film(
        step: int, *, disp_resp: Array, velc_resp: Array, accl_resp: Array, **_: Any
    ) -> Array:
        state = (one[journal][np.newaxis] for one in (disp_resp, velc_resp, accl_resp))
        added = np.zeros(machine.ndof)
        added[journal] = film.force(*state)[0]
        return added

    found: list[Array] = []

    def integrate() -> None:
        _, response, _ = machine.integrate_system(speed, force, time, add_to_RHS=with_film)
        found.append(response[1:, journal])

    machine.integrate_system(speed, force[:9], time[:9], add_to_RHS=with_film)
    elapsed = seconds(integrate)
    distance = np.linalg.norm(found[0], axis=1).reshape(revolutions, steps)
    return {"seconds": elapsed, "eccentricity": (distance.max(axis=1) / clearance).tolist()}


def compare(speed: float, revolutions: int, steps: int, criticals: int) -> dict[str, Any]:
    """The steady state, and the linear rotor's critical speeds [rad/s]."""
    speeds: list[float] = []

    def find_criticals(machine: Any) -> None:
        speeds[:] = machine.run_critical_speed(num_modes=criticals, rtol=1e-9).wn().tolist()

    find_criticals(rotor())
    machine = rotor()  # ROSS keeps the modes that a rotor has been asked for
    elapsed = seconds(lambda: find_criticals(machine))
    return {
        "steady_state": steady_state(machine, speed, revolutions, steps),
        "critical_speeds": speeds,
        "critical_seconds": elapsed,
    }


if __name__ == "__main__":
    answer(compare)
