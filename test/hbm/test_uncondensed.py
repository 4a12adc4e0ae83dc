"""Solutions put back into the uncondensed equations of all coordinates (Eqs. 3 to 5)."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import override

from .machines import PAPER, random_machine


def uncondensed_residual(balance, solution):
    """Norm of the imbalance over every coordinate and order, relative to that of the load."""
    model, harmonics, w = balance.model, solution.harmonics, solution.speed
    q = balance.response(solution)
    orders = np.arange(harmonics.highest * harmonics.revolutions + 1) / harmonics.revolutions
    angle = harmonics.revolutions * 2.0 * np.pi * np.arange(harmonics.samples) / harmonics.samples
    turning = np.exp(1j * np.multiply.outer(angle, orders))
    load = np.zeros_like(q)
    load[0] = model.static_force
    load[harmonics.revolutions] = w**2 * model.unbalance
    film = np.zeros_like(q)
    for (x, y), model_of_film in zip(model.journals, balance.films, strict=True):
        motion = [
            (turning @ ((1j * w * orders[:, None]) ** order * q[:, [x, y]])).real
            for order in (0, 1, 2)
        ]
        spectrum = np.fft.rfft(model_of_film.force(*motion), axis=0) / harmonics.samples
        film[:, [x, y]] = 2.0 * spectrum[: len(orders)]
        film[0, [x, y]] /= 2.0
    imbalance = [
        (model.K - (m * w) ** 2 * model.M + 1j * m * w * (model.C + w * model.G)) @ amplitudes
        for m, amplitudes in zip(orders, q, strict=True)
    ] - (load + film)
    return np.linalg.norm(imbalance) / np.linalg.norm(load)


@pytest.mark.parametrize("rpm", [1500.0, 3000.0, 3880.0, 4500.0, 9000.0])
@pytest.mark.parametrize("gravity", [False, True])
def test_paper_rotor(rpm, gravity):
    machine = override(PAPER, "gravity", gravity)
    balance = HarmonicBalance(machine, Harmonics(7))
    assert balance.model.K.shape == (102, 102)
    solution = solve(balance, rpm * np.pi / 30.0)
    assert solution.converged
    assert uncondensed_residual(balance, solution) < 1e-9


@pytest.mark.parametrize("dampers", [1, 2])
@pytest.mark.parametrize("anisotropic", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_random_machines(seed, anisotropic, dampers):
    machine = random_machine(seed, dampers=dampers, anisotropic=anisotropic, gravity=True)
    balance = HarmonicBalance(machine, Harmonics(7))
    solution = solve(balance, 250.0 + 60.0 * seed)
    assert solution.converged, solution.message
    assert uncondensed_residual(balance, solution) < 1e-9
