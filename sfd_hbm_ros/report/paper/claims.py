"""All claims of the paper, each with its judge."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sfd_hbm_ros.report.paper import inertia, loads, springs, unbalance
from sfd_hbm_ros.report.paper.cases import Cases, Claim
from sfd_hbm_ros.report.paper.judging import Judge, Judgement, Verdict, overall
from sfd_hbm_ros.report.paper.study import Study

JUDGES: Mapping[str, Judge] = {
    "P1": unbalance.p1,
    "P2": unbalance.p2,
    "P3": unbalance.p3,
    "P4": loads.p4,
    "P5": loads.p5,
    "P6": loads.p6,
    "P7": loads.p7,
    "P8": springs.p8,
    "P9": springs.p9,
    "P10": springs.p10,
    "P11": springs.p11,
    "P12": inertia.p12,
    "P13": inertia.p13,
    "P14": inertia.p14,
    "P15": inertia.p15,
    "P16": inertia.p16,
}


@dataclass(frozen=True)
class JudgedClaim:
    """A claim with a judgement on each of its parts, in their order."""

    name: str
    claim: Claim
    parts: Mapping[str, Judgement]

    @property
    def verdict(self) -> Verdict:
        """Verdict on the whole."""
        return overall(list(self.parts.values()))


def judge(cases: Cases, study: Study) -> Iterator[JudgedClaim]:
    """Judge every claim whose curves are all in the study."""
    for name, claim in cases.claims.items():
        if study.computed.keys() >= set(claim.curves):
            found = JUDGES[name](study, claim)
            yield JudgedClaim(name, claim, {part: found[part] for part in claim.says})
