"""Viscosities of oils against published ones and the standards' formulas."""

import math

import numpy as np
import pytest

from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.machine.oil import ISO_VG, LEAST_CELSIUS, MOST_CELSIUS, Oil

GRADES = tuple(ISO_VG)
CELSIUS = np.linspace(LEAST_CELSIUS, MOST_CELSIUS, 35)


def mm2_per_s(oil: Oil, celsius: float) -> float:
    return 1e6 * oil.kinematic_viscosity(celsius)


def test_the_papers_oil():
    """0.028 Pa s and 865 kg/m3 are VG 32 near 40 deg C."""
    assert Oil.iso_vg(32, 865.0).viscosity(40.0) == pytest.approx(0.028, rel=0.02)


@pytest.mark.parametrize("grade", GRADES)
def test_grades_are_those_of_iso_3448(grade):
    """Midpoints in mm2/s at 40 deg C, which but for the least round to the grade."""
    midpoint = {7: 6.8}.get(grade, float(grade))
    assert mm2_per_s(Oil.iso_vg(grade, 870.0), 40.0) == pytest.approx(midpoint, rel=1e-12)


@pytest.mark.parametrize(("h", "at_100"), [(28.97, 5.05), (57.31, 7.80), (69.48, 8.86)], ids=str)
def test_viscosities_at_100_belong_to_an_index_of_100(h, at_100):
    """H at 40 deg C of the viscosity at 100 deg C, from the worked examples of ASTM D2270."""
    cold, hot = np.log(np.array(list(ISO_VG.values()))).T
    assert math.exp(np.interp(math.log(h), cold, hot)) == pytest.approx(at_100, rel=3e-3)


@pytest.mark.parametrize(("grade", "at_100"), [(32, 5.4), (46, 6.8), (68, 8.7), (100, 11.4)])
def test_viscosities_at_100_are_those_of_data_sheets(grade, at_100):
    """Typical of mineral turbine oils, to the digit that data sheets give."""
    assert mm2_per_s(Oil.iso_vg(grade, 870.0), 100.0) == pytest.approx(at_100, abs=0.05)


def test_viscosity_at_50():
    """Specifications of turbine oils: VG 32 of 17.5 to 22.5 mm2/s, VG 46 of 28, each +-10 %."""
    assert 17.5 < mm2_per_s(Oil.iso_vg(32, 870.0), 50.0) < 22.5
    assert mm2_per_s(Oil.iso_vg(46, 870.0), 50.0) == pytest.approx(28.0, rel=0.1)


@pytest.mark.parametrize("oil", [Oil.iso_vg(46, 870.0), Oil(25.0, 5.0, 980.0)], ids=str)
def test_astm_d341(oil):
    """log10 log10(nu + 0.7) is a straight line over log10 T through both data points."""
    y = [math.log10(math.log10(mm2_per_s(oil, t) + 0.7)) for t in CELSIUS]
    x = np.log10(CELSIUS + 273.15)
    slope, intercept = np.polyfit(x, y, 1)
    np.testing.assert_allclose(intercept + slope * x, y, atol=1e-12)
    assert mm2_per_s(oil, 40.0) == pytest.approx(oil.viscosity_40, rel=1e-12)
    assert mm2_per_s(oil, 100.0) == pytest.approx(oil.viscosity_100, rel=1e-12)


@pytest.mark.parametrize("celsius", [0.0, 20.0, 60.0, 80.0, 100.0])
def test_density_is_that_of_astm_d1250(celsius):
    """Table 54D: rho = rho_15 exp(-a t (1 + 0.8 a t)), a = 0.6278/rho_15, t = T - 15 deg C."""
    at_15 = 880.0
    a = 0.6278 / at_15

    def density(celsius: float) -> float:
        rise = a * (celsius - 15.0)
        return at_15 * math.exp(-rise * (1.0 + 0.8 * rise))

    oil = Oil.iso_vg(46, density(40.0))
    ours = oil.viscosity(celsius) / oil.kinematic_viscosity(celsius)
    assert ours == pytest.approx(density(celsius), rel=3e-3)


@pytest.mark.parametrize("grade", GRADES)
def test_viscosity_falls_with_temperature_and_rises_with_the_grade(grade):
    oil, lighter = Oil.iso_vg(grade, 870.0), Oil.iso_vg(GRADES[0], 870.0)
    viscosities = np.array([oil.viscosity(t) for t in CELSIUS])
    assert (np.diff(viscosities) < 0.0).all()
    if grade != GRADES[0]:
        assert (viscosities > [lighter.viscosity(t) for t in CELSIUS]).all()


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Oil.iso_vg(33, 870.0), r"oil.grade must be one of .* 32, 46, .*, not 33"),
        (lambda: Oil.iso_vg(5, 870.0), r"oil.grade must be one of .* grades 7, 10, .*, not 5"),
        (lambda: Oil.iso_vg(32, 0.0), r"oil.density must be .* \[kg/m3\] above 0, not 0.0"),
        (lambda: Oil(math.nan, 5.0, 870.0), r"oil.viscosity_40 must be .* \[mm2/s\] .* not nan"),
        (lambda: Oil(32.0, 1.9, 870.0), r"oil.viscosity_100 must be .* of at least 2, not 1.9"),
        (lambda: Oil(32.0, 32.0, 870.0), r"oil.viscosity_100 must be below .* 32.0 mm2/s, not 32"),
        (lambda: Oil.configured(32, 0.0, 5.4, 870.0), r"oil.grade must be 0 .* given, not 32"),
        (lambda: Oil.configured(0, 32.0, 0.0, 870.0), r"oil.viscosity_100 must be .* not 0.0"),
    ],
)
def test_oils_that_cannot_be(make, sentence):
    with pytest.raises(MachineError, match=sentence):
        make()


def test_an_oil_is_configured_by_its_grade_or_by_two_viscosities():
    assert Oil.configured(46, 0.0, 0.0, 870.0) == Oil.iso_vg(46, 870.0)
    assert Oil.configured(0, 25.0, 5.0, 980.0) == Oil(25.0, 5.0, 980.0)
    assert Oil.configured(0, 0.0, 0.0, 870.0) is None


@pytest.mark.parametrize("celsius", [-20.1, 150.1, math.nan, math.inf, -math.inf])
def test_temperatures_without_a_viscosity(celsius):
    sentence = rf"oil.temperature must be .* from -20 to 150 deg C, not {celsius}"
    with pytest.raises(MachineError, match=sentence):
        Oil.iso_vg(32, 870.0).viscosity(celsius)
