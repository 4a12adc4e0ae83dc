"""Claims P8 to P11, on the centring spring (Sec. 4.3)."""

import numpy as np

from sfd_hbm_ros.report.paper.cases import Claim
from sfd_hbm_ros.report.paper.judging import Judgement, falling, judged, listed, near, rising
from sfd_hbm_ros.report.paper.loads import harmonics
from sfd_hbm_ros.report.paper.study import Study, journal
from sfd_hbm_ros.units import RPM


def p8(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Springs from soft to hard, without gravity."""
    numbers, within = claim.numbers, study.agreement["speed"]
    peaks = study.peaks(claim.curves)
    speeds = [peak.rpm for peak in peaks]
    heights = [peak.amplitude for peak in peaks]
    above = [study.amplitudes(claim.curves, rpm) for rpm in numbers["speeds_rpm"]]
    factor = _factor(study, claim.curves[0])
    softest_first = sum(falling(row) for row in above)
    return {
        "speed": judged(
            rising(speeds),
            listed(speeds, ".0f", "rpm"),
            _plateaus(study, claim, speeds),
        ),
        "peak": judged(rising(heights), f"eccentricities {listed(heights)}"),
        "factor": judged(factor < numbers["factor"], f"at most {factor:.2f}"),
        "above": judged(
            softest_first == len(above),
            f"in that order at {softest_first} of {len(above)} speeds from "
            f"{min(numbers['speeds_rpm']):.0f} to {max(numbers['speeds_rpm']):.0f} rpm; at "
            f"{numbers['speeds_rpm'][0]:.0f} rpm {listed(above[0])}",
        ),
        "hardest": judged(
            near(speeds[-1], numbers["rpm"], within),
            f"{speeds[-1]:.0f} rpm with {heights[-1]:.3f}",
        ),
    }


def _plateaus(study: Study, claim: Claim, speeds: list[float]) -> str:
    """Which springs break the order, and have a plateau that gives them no critical speed."""
    factors = [_factor(study, name) for name in claim.curves]
    disordered = [i for i in range(1, len(speeds)) if speeds[i] <= speeds[i - 1]]
    flat = sorted(
        {j for i in disordered for j in (i - 1, i) if factors[j] < claim.numbers["factor"]}
    )
    if not flat:
        return ""
    values = listed([factors[j] for j in flat], ".2f")
    return (
        f"at {listed([speeds[j] for j in flat], '.0f', 'rpm')} there is a plateau rather than a "
        f"resonance, with an amplification factor of at most {values}"
    )


def p9(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Springs from soft to hard, with gravity."""
    numbers, agreement = claim.numbers, study.agreement
    free, softer, soft, hard = (study.peak(name) for name in claim.curves)
    assert free is not None
    assert hard is not None
    return {
        "speed": judged(near(hard.rpm, numbers["rpm"], agreement["speed"]), f"{hard.rpm:.0f} rpm"),
        "eccentricity": judged(
            near(hard.amplitude, numbers["eccentricity"], agreement["eccentricity"]),
            f"{hard.amplitude:.3f}",
        ),
        "above": judged(
            hard.rpm > free.rpm and hard.amplitude > free.amplitude,
            f"by {hard.rpm - free.rpm:.0f} rpm and {hard.amplitude - free.amplitude:.3f}",
        ),
        "vanishes": judged(
            softer is None,
            f"{'no peak' if softer is None else f'a peak of {softer.amplitude:.3f}'} with 1500 "
            f"and {'none' if soft is None else f'one of {soft.amplitude:.3f}'} with 2500 lbf/in",
        ),
    }


def p10(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Orbit on a soft spring under gravity."""
    solution = study.start_up(claim.curves[0], claim.numbers["rpm"])
    motion = journal(solution)
    x, y = 0.5 * np.ptp(motion.orbit(), axis=0) / motion.clearance
    highest = solution.eccentricity_max
    return {
        "flat": judged(
            bool(x > claim.numbers["flat"] * y),
            f"half-widths {x:.3f} in x, {y:.3f} in y of clearance",
        ),
        "eccentric": judged(highest > claim.numbers["high"], f"eccentricity up to {highest:.3f}"),
    }


def p11(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Its spectrum."""
    amplitudes = harmonics(journal(study.start_up(claim.curves[0], claim.numbers["rpm"])))
    x, y = amplitudes.T
    least_x, least_y = study.agreement["visible"] * amplitudes[1:].max(axis=0)
    return {
        "y": judged(bool(y[:4].min() > least_y), f"{listed(y[:4].tolist(), '.4f')} of clearance"),
        "x": judged(
            bool(x[:2].min() > least_x > x[2:].max()),
            f"{listed(x[:4].tolist(), '.4f')} of clearance",
        ),
    }


def _factor(study: Study, name: str) -> float:
    """Peak speed over the width at 1/sqrt(2) of the peak, or at most that.

    The width counts only as far as the curve goes, where it does not fall so low.
    """
    branch = study.curve(name).branches[0]
    speed, height = branch.speed / RPM, branch.worst_eccentricity
    top = int(np.argmax(height))
    low = height < height[top] / np.sqrt(2.0)
    left = speed[:top][low[:top]].max(initial=speed[0])
    right = speed[top:][low[top:]].min(initial=speed[-1])
    return float(speed[top] / (right - left))
