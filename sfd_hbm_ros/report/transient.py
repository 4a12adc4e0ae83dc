"""The picture of a run in time."""

from collections.abc import Iterable

from matplotlib.axes import Axes

from sfd_hbm_ros.report.style import INK, LINE, QUIET, SECOND, label_abscissa, legend
from sfd_hbm_ros.report.units import grouped
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.integration.observed import ObservedJump
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import Transient
from sfd_hbm_ros.units import RPM

_TITLES = {
    Direction.RUN_UP: "run-up at {} rpm/s \N{RIGHTWARDS ARROW}",
    Direction.COAST_DOWN: "\N{LEFTWARDS ARROW} coast-down at {} rpm/s",
}


def draw_transient(
    axes: Axes, transient: Transient, damper: str, jumps: Iterable[ObservedJump] = ()
) -> None:
    """Draw the greatest and the mean eccentricity of each revolution of a run over the speed.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    transient : Transient
        The run, up or down.
    damper : str
        The damper whose eccentricity is drawn.
    jumps : iterable of ObservedJump, optional
        Jumps to mark.
    """
    rpm = transient.speed / RPM
    greatest, mean = transient.eccentricity_max[damper], transient.eccentricity_mean[damper]
    axes.plot(rpm, greatest, color=INK, linewidth=LINE, label="greatest in a revolution")
    axes.plot(rpm, mean, color=SECOND, linewidth=0.5 * LINE, label="mean of a revolution")
    for jump in jumps:
        place = jump.speed / RPM
        label = f"jump, {grouped(round(place, 1))} rpm"
        axes.axvline(place, color=QUIET, linewidth=0.5 * LINE, linestyle=":", label=label)
    label_abscissa(axes, "speed [rpm]")
    axes.set_ylabel("eccentricity $\\varepsilon$ [-]")
    highest = axes.dataLim.ymax
    axes.set_ylim(0.0, 1.0 if highest > 0.5 else 1.1 * highest)
    legend(axes, title=_title(transient.ramp), title_fontsize=8.0, alignment="left")


def _title(ramp: Ramp) -> str | None:
    if ramp.direction is None:
        return None
    return _TITLES[ramp.direction].format(grouped(round(abs(ramp.acceleration) / RPM, 6)))
