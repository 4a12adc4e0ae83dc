"""Large rotors: closed forms, and the sparse methods against the dense ones."""

import numpy as np
import pytest

from benchmarks.scaling import refined
from sfd_hbm_ros.rotor import assemble, critical_speeds, reduce_model, spectrum, whirl_modes
from sfd_hbm_ros.rotor.modes import MOST
from sfd_hbm_ros.rotor.reduction import _basis, _reduced

from .machines import beam, paper_rotor, rich_rotor
from .test_beams import LENGTH, exact_frequencies, pinned

ANISOTROPIC = ((2e7, 3e6), (-1e6, 1.5e7)), ((300.0, 20.0), (-40.0, 500.0))


@pytest.fixture
def as_if_large(monkeypatch):
    """Make every rotor a large one."""

    def change():
        _basis.cache_clear()
        _reduced.cache_clear()
        monkeypatch.setattr(spectrum, "_SMALL", 10)

    yield change
    _basis.cache_clear()
    _reduced.cache_clear()


@pytest.mark.parametrize("speed", [100.0, 3000.0])
def test_large_pinned_shaft_has_the_frequencies_of_timoshenko(speed):
    """Of 1 001 nodes, by Arnoldi's method; the discretisation's error is some 1e-6."""
    exact = sorted((w for n in (1, 2, 3) for w in exact_frequencies(n, 0.15, speed)), key=abs)
    found = whirl_modes(assemble(pinned(1000, 0.15)), speed)
    assert len(found) == MOST
    for w, mode in zip(exact, found, strict=False):
        assert mode.frequency == pytest.approx(abs(w), rel=1e-5)


@pytest.mark.parametrize(
    "machine", [paper_rotor(), rich_rotor(*ANISOTROPIC)], ids=["paper", "anisotropic"]
)
def test_lowest_whirl_modes_are_those_of_all(machine, as_if_large):
    model = assemble(machine)
    expected = whirl_modes(model, 300.0)
    as_if_large()
    monkey = whirl_modes(model, 300.0)
    for mode, other in zip(expected[:12], monkey[:12], strict=True):
        assert mode.frequency == pytest.approx(other.frequency, rel=1e-9)
        assert mode.direction == other.direction


@pytest.mark.parametrize(
    "machine",
    [paper_rotor(), rich_rotor(*ANISOTROPIC), beam(40, LENGTH, 0.05, 1e8)],
    ids=["paper", "anisotropic", "beam"],
)
def test_critical_speeds_are_those_of_all_modes(machine, as_if_large):
    model = assemble(machine)
    expected = critical_speeds(model)
    as_if_large()
    found = critical_speeds(model)
    assert [one.direction for one in found] == [one.direction for one in expected]
    assert [one.speed for one in found] == pytest.approx([one.speed for one in expected], rel=1e-9)


@pytest.mark.parametrize(
    "machine", [paper_rotor(), rich_rotor(*ANISOTROPIC)], ids=["paper", "anisotropic"]
)
def test_reduced_rotor_is_that_of_all_modes(machine, as_if_large):
    """Modes may differ in sign: the journals' dynamic stiffness does not."""
    model = assemble(machine)
    expected = reduce_model(model, 9000.0)
    as_if_large()
    found = reduce_model(model, 9000.0)
    assert found.size == expected.size
    w = 700.0
    for one, other in zip(
        journal_stiffness(found, w), journal_stiffness(expected, w), strict=True
    ):
        np.testing.assert_allclose(one, other, rtol=1e-8)


def journal_stiffness(model, w):
    dynamic = model.K + 1j * w * (model.C + 300.0 * model.G) - w * w * model.M
    inner = model.shaft_size
    solved = np.linalg.solve(dynamic[:inner, :inner], dynamic[:inner, inner:])
    yield np.linalg.norm(dynamic[inner:, inner:] - dynamic[inner:, :inner] @ solved)
    force = np.linalg.solve(dynamic, model.unbalance)
    yield np.abs(force[inner:])


def test_critical_speeds_of_ten_thousand_elements_are_those_of_a_coarse_mesh():
    """The paper's rotor has 2.6e-7 of discretisation in its first with 24 elements."""
    fine = critical_speeds(assemble(refined(9999)))
    coarse = critical_speeds(assemble(refined(240)))
    assert [one.direction for one in fine] == [one.direction for one in coarse]
    for one, other in zip(fine[:4], coarse[:4], strict=True):
        assert one.speed == pytest.approx(other.speed, rel=1e-5)
