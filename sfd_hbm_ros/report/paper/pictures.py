"""The figures of the paper, drawn from the computed curves."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Picture
from matplotlib.legend import Legend

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.report.curves import draw_response, draw_study
from sfd_hbm_ros.report.orbit import draw_orbits
from sfd_hbm_ros.report.paper.cases import Cases, Figure
from sfd_hbm_ros.report.paper.study import Study, journal
from sfd_hbm_ros.report.spectrum import draw_spectra, draw_spectrum
from sfd_hbm_ros.report.style import legend, new_figure, save

_MANY = 6  # curves whose legend would cover them


def draw_figures(cases: Cases, study: Study, folder: Path) -> list[Path]:
    """Draw every figure into a folder, which is made if need be.

    Returns
    -------
    list of Path
        The files, fig04.png to fig19.png.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawn = []
    for number, figure in cases.figures.items():
        picture = {"response": _response, "orbit": _orbits, "spectrum": _spectra}[figure.kind](
            study, figure
        )
        picture.suptitle(f"Fig. {number}: {figure.title}", fontsize=10.0)
        drawn.append(folder / f"fig{number:02d}.png")
        save(picture, drawn[-1])
    return drawn


def _response(study: Study, figure: Figure) -> Picture:
    """Response curves with their detached branches; a single one with its jumps."""
    picture, [axes] = new_figure()
    curves = {label: study.curve(name) for label, name in figure.curves.items()}
    [damper] = next(iter(curves.values())).dampers
    if len(curves) == 1:
        [(label, curve)] = curves.items()
        draw_response(axes, curve, damper, study.summary(figure.curves[label]).jumps)
    else:
        draw_study(axes, curves, damper)
    axes.set_xlim(figure.speeds_rpm)
    if len(curves) >= _MANY:
        _move_legend_aside(axes)
    return picture


def _orbits(study: Study, figure: Figure) -> Picture:
    """Orbits in the clearance circle, or a single one close up."""
    picture, [axes] = new_figure(size=(6.3, 4.6))
    motions = _motions(study, figure)
    draw_orbits(axes, motions, close_up=len(motions) == 1)
    return picture


def _spectra(study: Study, figure: Figure) -> Picture:
    """A spectrum of x and y, or several of each."""
    motions = _motions(study, figure)
    if len(motions) == 1:
        picture, [axes] = new_figure()
        [motion] = motions.values()
        draw_spectrum(axes, motion, logarithmic=True)
        return picture
    picture, [above, below] = new_figure(rows=2, size=(6.3, 5.6))
    draw_spectra(above, motions, "x", logarithmic=True)
    draw_spectra(below, motions, "y", logarithmic=True)
    _move_legend_aside(above)
    _legend_of(below).remove()
    return picture


def _move_legend_aside(axes: Axes) -> None:
    """Give axes their legend beside them instead of over their curves."""
    inside = _legend_of(axes)
    handles = inside.get_lines() or inside.get_patches()
    for handle, text in zip(handles, inside.get_texts(), strict=True):
        handle.set_label(text.get_text())
    legend(axes, handles, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _legend_of(axes: Axes) -> Legend:
    inside = axes.get_legend()
    assert inside is not None
    return inside


def _motions(study: Study, figure: Figure) -> dict[str, JournalMotion]:
    """Motions at the figure's speed by their names in its legend."""
    assert figure.rpm is not None
    return {
        label: journal(study.start_up(name, figure.rpm)) for label, name in figure.curves.items()
    }
