"""The branch settled by measured orbits: which of two responses the machine is on."""

from collections.abc import Mapping
from typing import NamedTuple

from sfd_hbm_ros.hbm import Solution
from sfd_hbm_ros.response.tracking.measured import Agreement, agreement, verdict
from sfd_hbm_ros.response.tracking.tracked import Tracked

CONFIRMATIONS = 3
"""Orbits in a row that have to speak against a known history before they are believed."""


class Judgement(NamedTuple):
    """What a measured orbit says about the operating point.

    Attributes
    ----------
    settles : Solution or None
        The response that the machine turns out to be on; None where nothing new is known.
    agreement : Agreement
        How the orbit compares with the response that the machine is held to be on from now on.
    message : str
        The same in a sentence.
    """

    settles: Solution | None
    agreement: Agreement
    message: str


class Settling:
    """Judges measured orbits, one after the other."""

    def __init__(self) -> None:
        self._contrary = 0

    def judge(self, measured: Mapping[str, float], tracked: Tracked, settled: bool) -> Judgement:
        """Compare an orbit with both responses at its speed, and settle which one it is.

        One orbit settles a branch that the history does not tell. Where the history tells it,
        `CONFIRMATIONS` in a row have to be decisive for the other one: a single orbit may have
        been measured while something passed.

        Parameters
        ----------
        measured : mapping of str to float
            The orbit, see `measured`.
        tracked : Tracked
            The operating point at the orbit's speed.
        settled : bool
            Whether the history tells the branch.
        """
        own, other = tracked.solution, tracked.other
        found = verdict(measured, [own, other] if other else [own])
        if not (other and found.decisive and found.best == 1):
            self._contrary = 0
            settles = own if other and found.decisive and not settled else None
            return Judgement(settles, agreement(measured, own), found.message)
        self._contrary += 1
        if settled and self._contrary < CONFIRMATIONS:
            message = f"{found.message}, which is the other branch's"
            return Judgement(None, agreement(measured, own), message)
        self._contrary = 0
        return Judgement(other, found.agreement, found.message)
