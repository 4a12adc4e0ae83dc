"""What varies along a response curve, as people read it."""

from dataclasses import dataclass

from sfd_hbm_ros.hbm.family import ParameterFamily
from sfd_hbm_ros.machine import unit_of
from sfd_hbm_ros.report.units import grouped
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.units import RPM


@dataclass(frozen=True)
class Abscissa:
    """The speed in rpm, or an entry of the machine file in its SI unit.

    Parameters
    ----------
    path : str or None
        Dotted path of the entry; None for the speed.
    symbol : str
        Symbol of the unit for people, '' for none.
    """

    path: str | None
    symbol: str = "rpm"

    @classmethod
    def of(cls, curve: ResponseCurve) -> "Abscissa":
        """That of a curve."""
        if not isinstance(curve.family, ParameterFamily):
            return cls(None)
        path = curve.family.path
        return cls(path, unit_of(curve.balance.machine, path))

    @property
    def unit(self) -> float:
        """Unit of the abscissa, in that of the curve's values."""
        return RPM if self.path is None else 1.0

    @property
    def title(self) -> str:
        """What it is, with its unit."""
        return f"{self.path or 'speed'} [{self.symbol or '-'}]"

    def worded(self, value: float) -> str:
        """A value of a curve, for people."""
        if self.path is None:
            return f"{grouped(round(value / RPM, 1))} rpm"
        return f"{value:.4g} {self.symbol}".rstrip()
