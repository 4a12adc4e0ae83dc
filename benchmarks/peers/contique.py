"""contique's side: the branch of Duffing's oscillator; runs in contique's environment."""

from typing import Any

import contique

from benchmarks.peers.exchange import answer
from benchmarks.peers.oscillator import Array, Duffing
from benchmarks.peers.problem import TOLERANCE, median_seconds
from sfd_hbm_ros.hbm import Harmonics
from sfd_hbm_ros.hbm.newton import newton


def follow(harmonics: int, samples: int, bounds: tuple[float, float], step: float) -> Any:
    """Follow the branch over a range of the frequency by steps of a part of the scales."""
    duffing = Duffing(Harmonics(harmonics, samples))
    low, high = bounds
    start = newton(duffing.at(low), duffing.linear_response(low)).x

    def slope(x: Array, w: float) -> Array:
        return duffing.slope(x, w)

    found: list[Array] = []

    def branch() -> None:
        found.clear()
        steps = contique.solve(
            fun=duffing.residual,
            x0=start,
            lpf0=low,
            jac=[duffing.jacobian, slope],
            dxmax=step * duffing.largest,
            dlpfmax=step * (high - low),
            args=(),
            control0=(-1, 1),
            maxsteps=100_000,
            tol=TOLERANCE,
        )
        for one in steps:
            found.append(one.x.copy())
            if one.x[-1] > high:
                break

    elapsed = median_seconds(branch, repeats=5)
    return {"seconds": elapsed / len(found), "points": [one.tolist() for one in found]}


if __name__ == "__main__":
    answer(follow)
