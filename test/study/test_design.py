"""The variants of a study: grids, samples, and both; the distributions against SciPy's."""

import numpy as np
import pytest
from scipy import stats

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.study.design import Design, check_variants
from sfd_hbm_ros.study.distributions import DISTRIBUTIONS, LogNormal, Normal, Uniform

from ..hbm.machines import PAPER

VISCOSITY, CLEARANCE = "dampers.damper_1.viscosity", "dampers.damper_1.clearance"


def test_last_entry_of_a_grid_varies_fastest():
    design = Design({"a": (1.0, 2.0), "b": (3.0, 4.0, 5.0)}, {})
    assert design.paths == ("a", "b")
    assert len(design) == 6
    expected = [[1, 3], [1, 4], [1, 5], [2, 3], [2, 4], [2, 5]]
    assert design.values.tolist() == expected


def test_every_point_of_a_grid_has_the_same_samples():
    scatter = {"b": Normal(5.0, 1.0), "c": Uniform(-1.0, 1.0)}
    values = Design({"a": (1.0, 2.0)}, scatter, samples=7, seed=3).values
    assert values.shape == (14, 3)
    assert values[:, 0].tolist() == [1.0] * 7 + [2.0] * 7
    assert np.array_equal(values[:7, 1:], values[7:, 1:])
    assert len(np.unique(values[:, 1:])) == 14


def test_more_samples_begin_with_the_fewer_and_another_seed_does_not():
    scatter = {"a": Normal(0.0, 1.0), "b": LogNormal(1.0, 0.3)}
    few = Design({}, scatter, samples=5).values
    assert np.array_equal(Design({}, scatter, samples=50).values[:5], few)
    assert not np.any(Design({}, scatter, samples=5, seed=1).values == few)


@pytest.mark.parametrize(
    ("distribution", "truth"),
    [
        (Normal(4.3e-4, 2e-5), stats.norm(4.3e-4, 2e-5)),
        (Uniform(-2.0, 3.0), stats.uniform(-2.0, 5.0)),
        (LogNormal(0.028, 0.2), stats.lognorm(0.2, scale=0.028)),
    ],
)
def test_samples_follow_their_distribution(distribution, truth):
    """Kolmogorov and Smirnov's test; the seed is fixed, so it always comes out the same."""
    values = Design({}, {"a": Uniform(0.0, 1.0), "b": distribution}, samples=2000).values
    assert stats.kstest(values[:, 1], truth.cdf).pvalue > 0.05
    assert abs(np.corrcoef(values.T)[0, 1]) < 3.0 / np.sqrt(2000)


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("normal", (1.0, 0.0)),
        ("normal", (np.nan, 1.0)),
        ("uniform", (2.0, 2.0)),
        ("uniform", (0.0, np.inf)),
        ("lognormal", (0.0, 1.0)),
        ("lognormal", (1.0, -1.0)),
    ],
)
def test_impossible_distributions_are_refused(name, parameters):
    with pytest.raises(ValueError, match=rf"^must be {name}\(.*\) of finite numbers"):
        DISTRIBUTIONS[name](*parameters)


def test_impossible_designs_are_refused():
    with pytest.raises(ValueError, match=r"^nothing varies"):
        Design({}, {})
    with pytest.raises(ValueError, match=r"^a: must be varied or sampled, not both"):
        Design({"a": (1.0, 2.0)}, {"a": Uniform(0.0, 1.0)})
    with pytest.raises(ValueError, match=r"^100100 variants: must be 100000 at most"):
        Design({"a": range(1001), "b": range(100)}, {})


def test_the_variant_that_is_no_machine_is_named():
    check_variants(Design({VISCOSITY: (0.01, 0.02), CLEARANCE: (1e-4, 2e-4)}, {}), PAPER)
    with pytest.raises(MachineError) as error:
        check_variants(Design({VISCOSITY: (0.01, 0.02), CLEARANCE: (1e-4, -2e-4)}, {}), PAPER)
    assert str(error.value) == (
        f"variant 1: {CLEARANCE} must be a finite number [m] above 0, not -0.0002"
    )
