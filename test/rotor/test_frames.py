"""Which rotors look the same from every side."""

import numpy as np
import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.rotor import is_axisymmetric, reduce_model

from ..hbm.machines import PAPER, random_machine


def test_rotor_on_alike_bearings_is_axisymmetric():
    model = HarmonicBalance(PAPER, Harmonics(1)).model
    assert is_axisymmetric(model)
    assert is_axisymmetric(reduce_model(model, 4000.0))


@pytest.mark.parametrize("highest", np.geomspace(2000.0, 20000.0, 12))
def test_reduced_anisotropic_rotor_is_not_whatever_its_number_of_modes(highest):
    """Modes of such a rotor come singly, so that their number may be odd."""
    model = HarmonicBalance(random_machine(5, anisotropic=True, gravity=True), Harmonics(1)).model
    assert not is_axisymmetric(model)
    assert not is_axisymmetric(reduce_model(model, highest))


def test_odd_numbers_of_modes_are_among_those():
    model = HarmonicBalance(random_machine(5, anisotropic=True, gravity=True), Harmonics(1)).model
    sizes = {
        reduce_model(model, highest).size % 2 for highest in np.geomspace(2000.0, 20000.0, 12)
    }
    assert sizes == {0, 1}
