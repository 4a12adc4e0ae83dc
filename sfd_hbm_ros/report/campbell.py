"""Campbell diagram: whirl frequencies over speed, with the speed itself as the 1x line."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from sfd_hbm_ros.report.style import (
    BESIDE,
    DASHES,
    INK,
    LINE,
    QUIET,
    SECOND,
    label_abscissa,
    legend,
)
from sfd_hbm_ros.report.units import HERTZ, grouped
from sfd_hbm_ros.rotor import CriticalSpeed, Direction, WhirlMode
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]

_STYLES = {
    Direction.FORWARD: (INK, "-"),
    Direction.BACKWARD: (SECOND, DASHES),
    Direction.PLANAR: (QUIET, "-"),
}


def draw_campbell(
    axes: Axes,
    speeds: Sequence[float],
    modes: Sequence[Sequence[WhirlMode]],
    criticals: Sequence[CriticalSpeed] = (),
) -> None:
    """Draw whirl frequencies up to twice the 1x line's highest.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    speeds : sequence of float
        Rotor speeds, rising [rad/s].
    modes : sequence of sequence of WhirlMode
        The modes at each speed, as from `rotor.campbell`.
    criticals : sequence of CriticalSpeed, optional
        Critical speeds to mark on the 1x line.
    """
    rpm = np.asarray(speeds) / RPM
    for sense, (colour, style) in _STYLES.items():
        for i, frequency in enumerate(_lines(modes, sense)):
            name = f"_{sense}" if i else f"{sense} whirl"
            axes.plot(rpm, frequency, color=colour, linestyle=style, linewidth=LINE, label=name)
    axes.plot(rpm, rpm / 60.0, color=QUIET, linewidth=0.5 * LINE, label="1x")
    for critical in criticals:
        if speeds[0] <= critical.speed <= speeds[-1]:
            _mark(axes, critical)
    label_abscissa(axes, "speed [rpm]")
    axes.set_ylabel("whirl frequency [Hz]")
    axes.set(xlim=(rpm[0], rpm[-1]), ylim=(0.0, 2.0 * rpm[-1] / 60.0))
    legend(axes, **BESIDE)


def _mark(axes: Axes, critical: CriticalSpeed) -> None:
    axes.plot(
        critical.speed / RPM,
        critical.speed / HERTZ,
        linestyle="none",
        marker="o",
        markersize=5.0,
        markerfacecolor="white",
        markeredgecolor=_STYLES[critical.direction][0],
        label=f"{critical.direction} critical, {grouped(round(critical.speed / RPM))} rpm",
    )


def _lines(modes: Sequence[Sequence[WhirlMode]], sense: Direction) -> list[Array]:
    """Frequencies [Hz] over the speeds of the first, second ... mode of one sense; NaN for none.

    At rest, where all modes are planar, a line begins at the planar mode nearest to it.
    """
    found = [[mode.frequency for mode in at if mode.direction is sense] for at in modes]
    table = np.full((len(modes), max(map(len, found))), np.nan)
    for row, frequencies in zip(table, found, strict=True):
        row[: len(frequencies)] = frequencies
    if not found[0]:
        at_rest = np.array([mode.frequency for mode in modes[0]])
        nearest = np.abs(np.subtract.outer(at_rest, table[1])).argmin(axis=0)
        table[0] = at_rest[nearest]
    return [line / HERTZ for line in table.T if np.isfinite(line).sum() > 1]
