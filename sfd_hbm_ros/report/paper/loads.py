"""Claims P4 to P7, on loads in one direction (Sec. 4.2)."""

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import JournalMotion, Solution
from sfd_hbm_ros.report.paper.cases import Claim
from sfd_hbm_ros.report.paper.judging import (
    Judgement,
    falling,
    judged,
    listed,
    near,
    rising,
    undecided,
)
from sfd_hbm_ros.report.paper.study import Study, journal, vibration
from sfd_hbm_ros.report.paper.unbalance import width_of_hysteresis
from sfd_hbm_ros.units import RPM

Array = NDArray[np.float64]


def p4(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Gravity beside none."""
    free, loaded = claim.curves
    before, after = study.peaks(claim.curves)
    speeds = claim.numbers["speeds_rpm"]
    gains = [
        study.amplitudes([loaded], rpm)[0] - study.amplitudes([free], rpm)[0] for rpm in speeds
    ]
    widths = [width_of_hysteresis(study, name) for name in claim.curves]
    ours = f"hysteresis of {widths[1]:.1f} rpm, without gravity of {widths[0]:.1f} rpm"
    jump = judged(bool(widths[1]) and not widths[0], ours)
    if 0.0 < max(widths) <= study.agreement["threshold_rpm"]:
        jump = undecided(ours, "with and without gravity the rotor is at the threshold (see P1)")
    return {
        "peak": judged(
            near(after.amplitude, before.amplitude, study.agreement["eccentricity"]),
            f"{after.amplitude:.3f} at {after.rpm:.0f} rpm, "
            f"without {before.amplitude:.3f} at {before.rpm:.0f} rpm",
        ),
        "higher": judged(
            min(gains) > 0.0,
            f"eccentricity higher by {min(gains):.3f} to {max(gains):.3f} "
            f"from {min(speeds):.0f} to {max(speeds):.0f} rpm",
        ),
        "jump": jump,
    }


def p5(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Response curves under growing loads."""
    absolute = [study.peak(name) for name in claim.curves]
    about_mean = [study.peak(name, vibration) for name in claim.curves]
    speeds = [peak.rpm if peak else np.nan for peak in absolute]
    heights = [peak.amplitude if peak else np.nan for peak in about_mean]
    eccentricities = [peak.amplitude if peak else np.nan for peak in absolute]
    beside_rpm = claim.numbers["beside_rpm"]
    beside = study.amplitudes(claim.curves, beside_rpm)
    static = [_offset(study.start_up(name, beside_rpm)) for name in claim.curves]
    rises = [height - level for height, level in zip(eccentricities, beside, strict=True)]
    rpm, heaviest = claim.numbers["rpm"], claim.curves[-1]
    slow = study.amplitudes(claim.curves, rpm)
    branch = study.curve(heaviest).branches[0]
    faster = branch.worst_eccentricity[branch.speed > rpm * RPM]
    return {
        "speed": judged(rising(speeds), listed(speeds, ".0f", "rpm")),
        "amplitude": judged(
            falling(heights),
            f"vibration about the mean {listed(heights)}, eccentricity {listed(eccentricities)}",
            f"as the static part grows, {listed(static)} of the clearance at {beside_rpm:.0f} "
            f"rpm, what the peak adds to the eccentricity there falls: {listed(rises)}"
            if rising(static) and falling(rises) and not falling(heights)
            else "",
        ),
        "slow": judged(
            slow[-1] == max(slow) and slow[-1] > max(faster),
            f"{slow[-1]:.4f} at {rpm:.0f} rpm, less at all higher speeds and for lighter loads"
            if slow[-1] == max(slow)
            else f"{listed(slow)} at {rpm:.0f} rpm",
        ),
    }


def _offset(solution: Solution) -> float:
    """Distance of the orbit's mean from the centre, of the clearance."""
    motion = journal(solution)
    return float(np.hypot(*motion.cos[0])) / motion.clearance


def p6(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Orbits under growing loads."""
    motions = _motions(study, claim)
    axes = np.array([_half_axes(motion) for motion in motions])
    flatness = (axes[:, 1] / axes[:, 0]).tolist()
    sizes = axes[:, 0].tolist()
    centres = [motion.cos[0, 0] / motion.clearance for motion in motions]
    shown = [
        abs(centre) > study.agreement["visible"] * size
        for centre, size in zip(centres, sizes, strict=True)
    ]
    return {
        "shape": judged(
            falling(flatness) and flatness[0] > claim.numbers["circle"],
            f"least over greatest width {listed(flatness)}",
        ),
        "shrinks": judged(falling(sizes), f"greatest half-width {listed(sizes)} of clearance"),
        "sideways": judged(
            any(shown) and not shown[0],
            f"centre at x/c = {listed(centres, '.4f')}",
        ),
    }


def p7(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Spectra under growing loads."""
    spectra = np.array([harmonics(motion) for motion in _motions(study, claim)])
    first = spectra[:, 1, 0].tolist()
    relative = spectra[:, 2:4].max(axis=2) / spectra[:, 1].max(axis=1)[:, np.newaxis]
    most = relative[1:].max(axis=0)
    appear = (most > study.agreement["visible"]) & (most > relative[0])
    return {
        "first": judged(falling(first), f"{listed(first, '.4f')} of clearance"),
        "others": judged(
            bool(appear.all()),
            f"2x {listed(relative[:, 0])} and 3x {listed(relative[:, 1])} of 1x",
        ),
    }


def harmonics(motion: JournalMotion) -> Array:
    """Amplitudes of each order in x and y, of the clearance, (k + 1, 2)."""
    amplitudes: Array = np.hypot(motion.cos, motion.sin) / motion.clearance
    return amplitudes


def _motions(study: Study, claim: Claim) -> list[JournalMotion]:
    rpm = claim.numbers["rpm"]
    return [journal(study.start_up(name, rpm)) for name in claim.curves]


def _half_axes(motion: JournalMotion) -> tuple[float, float]:
    """Half of the greatest and of the least width of an orbit over all directions."""
    angle = np.pi * np.arange(180) / 180
    heights = motion.orbit() @ np.array([np.cos(angle), np.sin(angle)])
    widths = 0.5 * np.ptp(heights, axis=0) / motion.clearance
    return float(widths.max()), float(widths.min())
