"""Claims P12 to P15, on the disks' polar inertia, and P16, on the size of the model."""

from itertools import pairwise

import numpy as np

from sfd_hbm_ros.report.paper.cases import Claim
from sfd_hbm_ros.report.paper.judging import Judgement, falling, judged, listed, rising
from sfd_hbm_ros.report.paper.study import Study


def p12(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Disk 1, with 1 to 16 times its inertia."""
    speeds, heights = _peaks(study, claim)
    below = [study.amplitudes(claim.curves, rpm) for rpm in claim.numbers["below_rpm"]]
    above = [study.amplitudes(claim.curves, rpm) for rpm in claim.numbers["above_rpm"]]
    return {
        "below": judged(
            all(row[0] == max(row) for row in below),
            _at(claim, "below_rpm", below),
            _turning(claim.numbers["below_rpm"], [row[0] == max(row) for row in below], speeds),
        ),
        "above": judged(all(row[0] == min(row) for row in above), _at(claim, "above_rpm", above)),
        "speed": judged(rising(speeds), listed(speeds, ".0f", "rpm")),
        "peak": judged(rising(heights), f"eccentricities {listed(heights, '.4f')}"),
    }


def _turning(rpm: list[float], first: list[bool], criticals: list[float]) -> str:
    """Where the smallest inertia ceases to respond most, if that is below every critical speed."""
    for (slower, before), (faster, after) in pairwise(zip(rpm, first, strict=True)):
        if before and not after and faster < min(criticals):
            return (
                f"the order turns between {slower:.0f} and {faster:.0f} rpm, below the lowest "
                f"critical speed of {min(criticals):.0f} rpm"
            )
    return ""


def p13(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Disk 2, with 1 to 16 times its inertia."""
    speeds, heights = _peaks(study, claim)
    above = [study.amplitudes(claim.curves, rpm) for rpm in claim.numbers["above_rpm"]]
    return {
        "speed": judged(
            bool(np.ptp(speeds) <= study.agreement["same"] * speeds[0]),
            listed(speeds, ".0f", "rpm"),
        ),
        "peak": judged(rising(heights), f"eccentricities {listed(heights, '.4f')}"),
        "above": judged(all(row[-1] == min(row) for row in above), _at(claim, "above_rpm", above)),
    }


def p14(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Disk 3, with 1 to 16 times its inertia."""
    speeds, heights = _peaks(study, claim)
    below = [study.amplitudes(claim.curves, rpm) for rpm in claim.numbers["below_rpm"]]
    alike = all(np.ptp(row) <= study.agreement["same"] * row[0] for row in below)
    return {
        "speed": judged(falling(speeds), listed(speeds, ".0f", "rpm")),
        "peak": judged(falling(heights), f"eccentricities {listed(heights, '.4f')}"),
        "below": judged(alike, _at(claim, "below_rpm", below)),
    }


def p15(study: Study, claim: Claim) -> dict[str, Judgement]:
    """The three disks, each with 16 times its inertia."""
    plain, *changed = _peaks(study, claim)[1]
    first, second, third = (abs(height / plain - 1.0) for height in changed)
    ours = (
        f"changes by {100 * first:.2f}, {100 * second:.2f}, {100 * third:.2f} % for disks 1 to 3"
    )
    return {
        "most": judged(first > max(second, third), ours),
        "least": judged(third < min(first, second), ours),
    }


def p16(study: Study, claim: Claim) -> dict[str, Judgement]:
    """Degrees of freedom and equations."""
    balance = study.curve(claim.curves[0]).balance
    journals = balance.model.journals.size
    rotor = balance.model.size - journals
    k, unknowns = balance.harmonics.highest, balance.harmonics.rows * journals
    return {
        "rotor": judged(rotor == claim.numbers["rotor"], f"{rotor}"),
        "damper": judged(journals == claim.numbers["damper"], f"{journals}"),
        "iterated": judged(unknowns == 2 * (2 * k + 1), f"{unknowns} with k = {k}"),
    }


def _peaks(study: Study, claim: Claim) -> tuple[list[float], list[float]]:
    """Critical speeds [rpm] and peaks of the claim's curves."""
    peaks = study.peaks(claim.curves)
    return [peak.rpm for peak in peaks], [peak.amplitude for peak in peaks]


def _at(claim: Claim, key: str, rows: list[list[float]]) -> str:
    """Amplitudes at each of the claim's speeds."""
    return "; ".join(
        f"{rpm:.0f} rpm: {listed(row, '.4f')}"
        for rpm, row in zip(claim.numbers[key], rows, strict=True)
    )
