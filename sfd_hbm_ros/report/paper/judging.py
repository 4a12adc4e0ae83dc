"""A judgement: what we find where the paper claims something, and whether the two agree."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

from sfd_hbm_ros.report.paper.cases import Claim
from sfd_hbm_ros.report.paper.study import Study


class Verdict(StrEnum):
    """Whether a claim holds for the reconstructed rotor."""

    HOLDS = "holds"
    DIFFERS = "differs"
    OPEN = "cannot be judged"


@dataclass(frozen=True)
class Judgement:
    """Of one part of a claim.

    Attributes
    ----------
    ours : str
        What we find.
    verdict : Verdict
        Whether the claim holds.
    why : str
        The reason, where the numbers alone do not give it.
    """

    ours: str
    verdict: Verdict
    why: str = ""


Judge = Callable[[Study, Claim], dict[str, Judgement]]
"""Judges a claim from the curves of a study, by the names of the claim's parts."""


def judged(holds: bool, ours: str, why: str = "") -> Judgement:
    """A judgement that the numbers decide.

    What is claimed to be the reason of a difference is for the numbers to support, too: `why` is
    empty where they do not.
    """
    return Judgement(ours, Verdict.HOLDS if holds else Verdict.DIFFERS, why)


def undecided(ours: str, why: str) -> Judgement:
    """A judgement that the reconstruction is not exact enough for."""
    return Judgement(ours, Verdict.OPEN, why)


def overall(parts: Sequence[Judgement]) -> Verdict:
    """Verdict on a claim of several parts: it holds where all do."""
    verdicts = {part.verdict for part in parts}
    return next(one for one in (Verdict.DIFFERS, Verdict.OPEN, Verdict.HOLDS) if one in verdicts)


def near(ours: float, theirs: float, within: float) -> bool:
    """Whether a number is within a part of the paper's."""
    return abs(ours - theirs) <= within * abs(theirs)


def rising(values: Sequence[float]) -> bool:
    """Whether every value is greater than the one before."""
    return all(after > before for before, after in pairwise(values))


def falling(values: Sequence[float]) -> bool:
    """Whether every value is less than the one before."""
    return rising([-value for value in values])


def listed(values: Sequence[float], form: str = ".3f", unit: str = "") -> str:
    """The values one after another, as a sentence has them."""
    text = ", ".join(format(value, form) for value in values)
    return f"{text} {unit}".rstrip()
