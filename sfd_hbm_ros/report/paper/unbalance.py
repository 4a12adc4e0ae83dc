"""Claims P1 to P3, on larger unbalances (Sec. 4.1)."""

import numpy as np

from sfd_hbm_ros.hbm import stability
from sfd_hbm_ros.report.paper.cases import Claim
from sfd_hbm_ros.report.paper.disturbed import third_harmonic
from sfd_hbm_ros.report.paper.judging import Judgement, judged, listed, near, undecided
from sfd_hbm_ros.report.paper.study import Study, journal
from sfd_hbm_ros.units import RPM


def p1(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Three unbalances too small for a jump."""
    agreement = study.agreement
    peaks = study.peaks(claim.curves)
    speeds = [peak.rpm for peak in peaks]
    heights = [peak.amplitude for peak in peaks]
    widths = [width_of_hysteresis(study, name) for name in claim.curves]
    ours = f"hysteresis of {listed(widths, '.1f', 'rpm')} on disks 1, 2, 3"
    no_jump = judged(not any(widths), ours)
    if 0.0 < max(widths) <= agreement["threshold_rpm"]:
        no_jump = undecided(
            ours, "the rotor is at the threshold of jumping, nearer than it could be reconstructed"
        )
    alike = np.ptp(speeds) <= agreement["same"] * max(speeds) and np.ptp(heights) <= agreement[
        "similar"
    ] * max(heights)
    return {
        "no_jump": no_jump,
        "alike": judged(
            bool(alike), f"{listed(speeds, '.0f', 'rpm')} with eccentricities {listed(heights)}"
        ),
        "order": judged(heights[0] < heights[2] < heights[1], f"eccentricities {listed(heights)}"),
    }


def p2(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Three unbalances large enough for a jump."""
    numbers = claim.numbers
    jumps = [jump.value / RPM for name in claim.curves for jump in study.summary(name).jumps]
    widths = [width_of_hysteresis(study, name) for name in claim.curves]
    judgements = {
        "jumps": judged(all(widths), f"{len(jumps)} jumps on disks 1, 2, 3 together"),
        "range": judged(
            numbers["lowest_rpm"] <= min(jumps) and max(jumps) <= numbers["highest_rpm"],
            f"{min(jumps):.0f} to {max(jumps):.0f} rpm",
        ),
        "order": judged(
            widths[0] < widths[2] < widths[1], f"{listed(widths, '.0f', 'rpm')} on disks 1, 2, 3"
        ),
    }
    for disk, (name, width) in enumerate(zip(claim.curves, widths, strict=True), start=1):
        agrees = near(width, numbers[f"disk_{disk}_rpm"], study.agreement["width"])
        ours = f"{width:.1f} rpm"
        judgements[f"width_{disk}"] = judged(agrees, ours, _beside(study, name, width))
    return judgements


def p3(study: Study, claim: Claim) -> dict[str, Judgement]:
    """3x in the response of an axisymmetric rotor without a static load.

    It is sought in the harmonic balance, as an instability of the circular orbit, and in time
    after a disturbance.
    """
    numbers, [name] = claim.numbers, claim.curves
    solution = study.start_up(name, numbers["rpm"])
    balance = study.curve(name).balance
    motion = journal(solution)
    amplitudes = np.linalg.norm(np.hypot(motion.cos, motion.sin), axis=1)
    leading = np.abs(stability(balance, solution).multipliers[0])
    first, last = (int(revolutions) for revolutions in numbers["revolutions"])
    early, late = third_harmonic(balance, solution, numbers["disturbance"], (first, last))
    relative = amplitudes / amplitudes[1]
    stable = bool(leading < 1.0)
    ours = (
        f"3x is {relative[3]:.0e} of 1x at an eccentricity of {solution.eccentricity_max:.3f}; "
        f"the orbit is {'stable' if stable else 'unstable'}, with a leading Floquet multiplier of "
        f"{leading:.3f}; integrated in time from a disturbance of {numbers['disturbance']:g} of "
        f"the clearance, 3x is {early:.0e} of 1x after {first} revolutions and {late:.0e} after "
        f"{first + last}"
    )
    visible = study.agreement["visible"]
    reasons = []
    if np.delete(relative, 1).max() < visible:
        reasons.append("the orbit is a circle about the centre, which has 1x alone")
        if stable:
            reasons.append("no instability makes another orbit of it")
    if late < early < visible:
        reasons.append("what 3x a disturbance brings is not seen and dies out")
    elif late < visible <= early:
        reasons.append("3x is seen while a disturbance dies out, before the response has settled")
    why = "; ".join(reasons)
    shown = relative[3] > visible
    return {"third": judged(bool(shown), ours, why)}


def width_of_hysteresis(study: Study, name: str) -> float:
    """Distance of the jumps of start-up and coast-down [rpm], 0 where there are none."""
    return (study.summary(name).hysteresis or 0.0) / RPM


def _beside(study: Study, name: str, width: float) -> str:
    """What detached branches add to a hysteresis."""
    spans = [
        (branch.speed.min() / RPM, branch.speed.max() / RPM)
        for branch in study.curve(name).detached
    ]
    if not spans:
        return ""
    low, high = min(span[0] for span in spans), max(span[1] for span in spans)
    return (
        f"a detached branch, which no run-up meets, lies from {low:.0f} to {high:.0f} rpm: "
        f"with it, there are several responses over {width + high - low:.0f} rpm"
    )
