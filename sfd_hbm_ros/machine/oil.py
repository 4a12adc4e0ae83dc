"""The oil of the dampers: its viscosity at a temperature."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from sfd_hbm_ros.machine.errors import MachineError, not_one_of, show
from sfd_hbm_ros.machine.parts import Part
from sfd_hbm_ros.machine.rules import number

ISO_VG = {
    7: (6.8, 2.08),
    10: (10.0, 2.66),
    15: (15.0, 3.41),
    22: (22.0, 4.29),
    32: (32.0, 5.36),
    46: (46.0, 6.76),
    68: (68.0, 8.73),
    100: (100.0, 11.38),
    150: (150.0, 15.02),
    220: (220.0, 19.44),
    320: (320.0, 24.95),
    460: (460.0, 31.77),
    680: (680.0, 41.13),
    1000: (1000.0, 52.78),
    1500: (1500.0, 68.34),
}
"""Kinematic viscosity [mm2/s] at 40 and 100 deg C of the viscosity grades.

At 40 deg C it is the midpoint of the grade (ISO 3448; an oil may differ by 10 %).
At 100 deg C it is that of an oil of viscosity index 100, whose viscosity at 40 deg C is H of ASTM
D2270. Below VG 7 that index is not defined.
"""

LEAST_CELSIUS, MOST_CELSIUS = -20.0, 150.0
"""Temperatures between which a viscosity is given [deg C]."""

_EXPANSION = 0.6278  # kg/m3/K, of lubricating oils, over the density: ASTM D1250, table 54D
_LEAST = 2.0  # mm2/s, from which on ASTM D341 holds with the constant 0.7 alone


@dataclass(frozen=True)
class Oil(Part):
    """An oil by what its data sheet says.

    Raises
    ------
    MachineError
        If a value is not allowed, or the viscosity does not fall with the temperature.
    """

    place: ClassVar[str] = "oil"

    viscosity_40: Annotated[float, number("viscosity at 40 deg C", "mm2/s", least=_LEAST)]
    viscosity_100: Annotated[float, number("viscosity at 100 deg C", "mm2/s", least=_LEAST)]
    density: Annotated[float, number("density at 40 deg C", "kg/m3", above=0.0)]

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.viscosity_100 >= self.viscosity_40:
            limit = f"must be below the viscosity at 40 deg C of {self.viscosity_40} mm2/s"
            raise self.error("viscosity_100", f"{limit}, not {self.viscosity_100}")

    @classmethod
    def iso_vg(cls, grade: int, density: float) -> Oil:
        """Return the mineral oil of an ISO viscosity grade and a density at 40 deg C [kg/m3].

        Raises
        ------
        MachineError
            If there is no such grade, or the density is not allowed.
        """
        if grade not in ISO_VG:
            problem = not_one_of("ISO viscosity grades", map(str, ISO_VG), grade)
            raise MachineError(problem, "grade", cls.place)
        return cls(*ISO_VG[grade], density)

    @classmethod
    def configured(
        cls, grade: int, viscosity_40: float, viscosity_100: float, density: float
    ) -> Oil | None:
        """Return the oil of a grade or, where that is 0, of two viscosities; None where all are 0.

        Parameters
        ----------
        grade : int
            ISO viscosity grade.
        viscosity_40, viscosity_100 : float
            Kinematic viscosities at 40 and 100 deg C [mm2/s].
        density : float
            Density at 40 deg C [kg/m3].

        Raises
        ------
        MachineError
            If a grade and viscosities are given, or the oil is not allowed.
        """
        measured = viscosity_40 != 0.0 or viscosity_100 != 0.0
        if grade and measured:
            problem = "must be 0 where viscosity_40 or viscosity_100 is given"
            raise MachineError(f"{problem}, not {grade}", "grade", cls.place)
        if measured:
            return cls(viscosity_40, viscosity_100, density)
        return cls.iso_vg(grade, density) if grade else None

    def kinematic_viscosity(self, celsius: float) -> float:
        """Return the kinematic viscosity [m2/s] at a temperature [deg C], by ASTM D341.

        log log(nu + 0.7) = A - B log T, nu in mm2/s and T in K, goes through the viscosities at
        40 and 100 deg C.

        Raises
        ------
        MachineError
            If the temperature is not allowed.
        """
        if not LEAST_CELSIUS <= celsius <= MOST_CELSIUS:
            allowed = f"from {LEAST_CELSIUS:g} to {MOST_CELSIUS:g} deg C"
            problem = f"must be a temperature {allowed}, not {show(celsius)}"
            raise MachineError(problem, "temperature", self.place)
        cold, hot = (
            math.log(math.log(nu + 0.7)) for nu in (self.viscosity_40, self.viscosity_100)
        )
        part = math.log(_kelvin(celsius) / _kelvin(40.0)) / math.log(
            _kelvin(100.0) / _kelvin(40.0)
        )
        return (math.exp(math.exp(cold + part * (hot - cold))) - 0.7) * 1e-6

    def viscosity(self, celsius: float) -> float:
        """Return the dynamic viscosity [Pa s] at a temperature [deg C].

        The density is that at 40 deg C, thinned by the thermal expansion of lubricating oils.

        Raises
        ------
        MachineError
            If the temperature is not allowed.
        """
        thinned = math.exp(-_EXPANSION / self.density * (celsius - 40.0))
        return self.kinematic_viscosity(celsius) * self.density * thinned


def _kelvin(celsius: float) -> float:
    return celsius + 273.15
