"""Bode plot of the 1x vibration: amplitude and phase lag over speed."""

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from sfd_hbm_ros.report.stretches import draw_branch, unstable_key
from sfd_hbm_ros.report.style import INK, label_abscissa, legend
from sfd_hbm_ros.report.units import MICROMETRE
from sfd_hbm_ros.report.vibration import FIRST, vibration
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LEAST_LAG = -45.0  # at which a branch may begin [deg]


def draw_bode(
    amplitude: Axes,
    phase: Axes,
    curve: ResponseCurve,
    damper: str,
    axis: Literal["x", "y"] = "x",
    peak_to_peak: bool = False,
) -> None:
    """Draw amplitude and phase of the 1x vibration of a journal, unstable parts dashed.

    The vibration is A cos(angle - lag): the lag is that of its high spot behind the keyphasor.
    Quasi-periodic branches are left out.

    Parameters
    ----------
    amplitude, phase : Axes
        Where to draw each: one above the other, with one abscissa.
    curve : ResponseCurve
        The curve, over the speed.
    damper : str
        The damper.
    axis : {"x", "y"}
        The direction in which a probe looks.
    peak_to_peak : bool
        Whether the amplitude is from peak to peak, instead of from zero to peak.
    """
    unit = MICROMETRE / (2.0 if peak_to_peak else 1.0)
    branches = [branch for branch in curve.branches if branch.periodic]
    for branch in branches:
        speed, first = branch.speed / RPM, _first(branch, damper, axis)
        draw_branch(amplitude, branch, speed, np.abs(first) / unit, INK)
        draw_branch(phase, branch, speed, _lag(first), INK)
    amplitude.set_ylabel(f"1x amplitude of ${axis}$ [µm, {'pk-pk' if peak_to_peak else '0-pk'}]")
    amplitude.set_ylim(bottom=0.0)
    phase.set_ylabel("phase lag [°]")
    phase.yaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1.0, 1.5, 3.0, 4.5, 9.0, 10.0]))
    phase.invert_yaxis()
    amplitude.margins(x=0.0)
    label_abscissa(phase, "speed [rpm]")
    keys = unstable_key(branches, INK)
    if keys:
        legend(amplitude, keys)


def _first(branch: CurveBranch, damper: str, axis: str) -> ComplexArray:
    """Complex amplitudes of 1x [m], x(t) = Re(X exp(i W t))."""
    vibrations = [vibration(solution.journals[damper]) for solution in branch.solutions]
    return np.array([one[FIRST]["xy".index(axis)] for one in vibrations])


def _lag(first: ComplexArray) -> Array:
    """Phase lag [deg] without jumps along a branch, which begins between -45 and 315 degrees."""
    lag: Array = -np.degrees(np.unwrap(np.angle(first)))
    lag -= 360.0 * np.floor((lag[0] - _LEAST_LAG) / 360.0)
    return lag
