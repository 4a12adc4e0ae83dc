"""Radau's methods against the coefficients and properties that the textbook gives."""

import numpy as np
import pytest

from sfd_hbm_ros.response.integration.collocation import Radau

ROOT6 = np.sqrt(6.0)


def test_three_stages_are_the_textbooks():
    """Hairer and Wanner 1996, Solving ODEs II, Table IV.5.6."""
    radau = Radau(3)
    assert radau.nodes == pytest.approx([(4.0 - ROOT6) / 10.0, (4.0 + ROOT6) / 10.0, 1.0])
    expected = [
        [(88 - 7 * ROOT6) / 360, (296 - 169 * ROOT6) / 1800, (-2 + 3 * ROOT6) / 225],
        [(296 + 169 * ROOT6) / 1800, (88 + 7 * ROOT6) / 360, (-2 - 3 * ROOT6) / 225],
        [(16 - ROOT6) / 36, (16 + ROOT6) / 36, 1 / 9],
    ]
    assert radau.first == pytest.approx(np.array(expected), abs=1e-14)


@pytest.mark.parametrize("stages", [2, 3, 5, 8, 12])
class TestProperties:
    def test_integrates_polynomials_exactly(self, stages):
        """The stages to degree s - 1, the end of the step to degree 2s - 2."""
        radau = Radau(stages)
        powers = np.arange(2 * stages - 1)
        values = radau.nodes[:, np.newaxis] ** powers
        assert radau.first[-1] @ values == pytest.approx(1.0 / (powers + 1.0), abs=1e-13)
        low = powers[:stages]
        expected = radau.nodes[:, np.newaxis] ** (low + 1) / (low + 1.0)
        assert radau.first @ values[:, :stages] == pytest.approx(expected, abs=1e-13)

    def test_is_l_stable(self, stages):
        """|R(z)| <= 1 on the imaginary axis, and R(z) -> 0 for z -> -infinity."""
        a = Radau(stages).first

        def growth(z):
            return 1.0 + z * a[-1] @ np.linalg.solve(np.eye(stages) - z * a, np.ones(stages))

        for y in np.geomspace(0.01, 1e4, 60):
            assert abs(growth(1j * y)) <= 1.0 + 1e-12
        assert abs(growth(-1e8)) < 1e-5

    def test_displacements_agree_with_the_stages(self, stages):
        radau = Radau(stages)
        assert radau.displacements(radau.nodes) == pytest.approx(radau.second, abs=1e-14)
        assert radau.values(radau.nodes) == pytest.approx(np.eye(stages), abs=1e-11)

    def test_last_term_is_that_of_the_highest_polynomial(self, stages):
        """Of a displacement that is the polynomial P_(s+1) it is all."""
        radau = Radau(stages)
        highest = np.polynomial.legendre.Legendre.basis(stages + 1, domain=[0.0, 1.0])
        acceleration = highest.deriv(2)(radau.nodes)
        assert radau.last_term @ acceleration == pytest.approx(1.0, rel=1e-9)


def test_one_stage_is_refused():
    with pytest.raises(ValueError, match="stages: 1 is not allowed, it must be at least 2"):
        Radau(1)
