"""The operating point of a machine, followed with its history.

The machine stays on its branch until that folds back or closes on the clearance; there it jumps
to the other stable response that is nearest in eccentricity. That holds for speed, loads and
parameters, either way. The response curve guides: it says where the folds are, and from where
Newton's method starts. Without a current one the response is followed by arclength where it moves
far, so that a fold shows. A machine that moves quasi-periodically about an unstable circular orbit
has that circle as its solution, its place on the quasi-periodic branch, and jumps at its end.
What followed a speed that was measured wrongly is forgotten when the next one shows it.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Solution
from sfd_hbm_ros.hbm.time_limit import ELAPSED, TimeLimitError, time_limit
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.place import Place
from sfd_hbm_ros.response.errors import unexpected
from sfd_hbm_ros.response.tracking.excursion import Excursion
from sfd_hbm_ros.response.tracking.guide import Guide
from sfd_hbm_ros.response.tracking.operating_point import OperatingPoint, begun, placed
from sfd_hbm_ros.response.tracking.pursuit import pursued, travelled
from sfd_hbm_ros.response.tracking.tracked import BranchName, Tracked, branch_name, no_solution
from sfd_hbm_ros.rotor import ResonanceError
from sfd_hbm_ros.threads import one_blas_thread

_STUCK = 2.0  # searches broken off in a row, after which their start is given up
_BUSY = 0.1  # what one counts for which the computer was too busy


class _Known(NamedTuple):
    """What a tracker knows of its machine."""

    last: OperatingPoint | None = None
    settled: bool = False  # whether the history tells the branch
    origin: float | None = None  # speed from which a response not settled was followed
    stuck: float = 0.0  # searches in a row that were broken off


class Tracker:
    """Follows the operating point of a machine.

    A tracker without a history assumes the response that a run-up through the curve meets, or
    without a curve the one that `solve` finds. It calls it unknown wherever there are others,
    until `settle` decides or the machine comes where there is a single one.

    Parameters
    ----------
    balance : HarmonicBalance
        The machine and the harmonics.
    patience : float
        Processor time that the search for a response may take [s]; where it is over, a prediction
        has no solution. So it is after a great change for which there is no curve yet.

    Attributes
    ----------
    trusted : bool
        Whether the curve, outdated or not, tells of the machine: its user's judgement.
    """

    def __init__(self, balance: HarmonicBalance, patience: float = math.inf) -> None:
        self._guide = Guide(balance)
        self._patience = patience
        self.trusted = False
        self._beside: tuple[Place, Solution | None] | None = None  # the other stable response
        self._known = _Known()
        self._excursion = Excursion[_Known]()

    @property
    def settled(self) -> bool:
        """Whether the history tells on which branch the machine is."""
        return self._known.settled

    @property
    def origin(self) -> float | None:
        """Speed from which a response not settled was followed [rad/s]; None if not known."""
        return self._known.origin

    @property
    def current(self) -> bool:
        """Whether there is a curve, and it is that of the present machine."""
        return self._guide.current

    @property
    def guide(self) -> Guide:
        """The machine, and the curve that guides it."""
        return self._guide

    @property
    def place(self) -> Place | None:
        """Where on the curve the machine is; None where that is not known."""
        return self._known.last.place if self._known.last else None

    @one_blas_thread
    def change(self, balance: HarmonicBalance) -> None:
        """Go on with other loads, parameters or harmonics of the machine."""
        self._guide = Guide(balance, self._guide.curve)
        self._beside = None
        self._learn(origin=None)

    @one_blas_thread
    def adopt(self, curve: ResponseCurve) -> None:
        """Be guided by a curve over the speed, current or outdated, in place of any other."""
        self._guide = guide = Guide(self._guide.balance, curve)
        self._beside = None
        self._known = self._replaced(self._known)
        if guide.current and self._known.origin is not None:
            stable = [place for place in guide.places(self._known.origin) if place.stable]
            self._learn(settled=self.settled or len(stable) == 1)

    @one_blas_thread
    def settle(self, solution: Solution) -> None:
        """Know that the machine is on a response, which was measured or restored.

        Raises
        ------
        ValueError
            If the solution did not converge.
        """
        if not solution.converged:
            raise ValueError(f"there is no solution at {solution.speed} rad/s to settle on")
        self._learn(last=placed(self._guide, solution), settled=True)
        self._excursion = Excursion()

    def assume(self, solution: Solution, origin: float | None) -> None:
        """Go on from a response on which the machine may be, followed from a speed [rad/s]."""
        self.settle(solution)
        self._learn(settled=False, origin=origin)

    def forget(self) -> None:
        """Begin anew: what the machine did meanwhile is not known."""
        self._known, self._beside = _Known(), None
        self._excursion = Excursion()

    @one_blas_thread
    def predict(self, speed: float, time: float = math.nan) -> Tracked:
        """Follow the machine to a speed.

        On a current curve this takes one run of Newton's method, two where there is another
        stable response, whether the machine jumps or not. Without one it takes a run for each
        stride of `follow`, mostly one, or where it comes near a fold at most `following.POINTS`
        points of a branch. If the machine jumps then, there is one run for each place of an
        outdated curve, and at most five calls of `solve`.

        No exception is raised. Where there is no solution, or the speed is not positive and
        finite, the solution says so, and the next prediction starts from the last that converged.
        Only where two searches in a row are broken off, for their time or an exception, the next
        begins anew: they would be for ever where the last response is one from which none leads.

        Parameters
        ----------
        speed : float
            Rotor speed [rad/s].
        time : float, optional
            When it was measured [s]. With it, speeds that leap away and are back at once are
            taken for wrong, and where they led is forgotten.
        """
        if not 0.0 < speed < math.inf:
            reason = f"speed: {speed} rad/s is not allowed, it must be positive and finite"
            return Tracked(no_solution(self._guide.balance, speed, reason))
        before, busy = self._excursion.returned(speed, time, self._known), False
        bug = None
        try:
            with np.errstate(all="ignore"):  # where numbers overflow there is no solution
                if before is not None:
                    self._known = self._replaced(before)
                with time_limit(self._patience):
                    point = self._advanced(speed)
                if not point.solution.converged:
                    return Tracked(point.solution)
                self._learn(last=point)
                tracked = self._tracked(point)
                self._learn(stuck=0.0)
                away, wrong = self._excursion.away, before is not None
                return replace(tracked, doubtful=away, wrong_before=wrong)
        except ResonanceError as error:
            return Tracked(no_solution(self._guide.balance, speed, str(error)))
        except TimeLimitError as error:
            reason = f"no solution was found within {self._patience:g} s of processor time"
            busy = error.busy
            if busy:
                elapsed = ELAPSED * self._patience
                reason = f"no solution was found within {elapsed:g} s, as the computer is busy"
        except (ArithmeticError, np.linalg.LinAlgError) as error:  # beyond what numbers can hold
            reason = f"{type(error).__name__}: {error}"
        except Exception as error:
            reason, bug = unexpected(error), error
        self._break_off(busy)
        return Tracked(no_solution(self._guide.balance, speed, reason), bug=bug)

    def _advanced(self, speed: float) -> OperatingPoint:
        last = self._known.last
        if last is None:
            self._learn(origin=speed)
            return begun(self._guide, speed)
        there = travelled(self._guide, last, speed)
        if there:
            return there
        self._learn(origin=self._known.origin or speed)
        return pursued(self._guide, last, speed, 0.5 * self._patience)

    def _break_off(self, busy: bool) -> None:
        """Note that a search was broken off, and after `_STUCK` forget where it started.

        On a busy computer that happens to searches that lead somewhere, too: they count less.
        """
        stuck = self._known.stuck + (_BUSY if busy else 1.0)
        self._known = self._known._replace(stuck=stuck) if stuck < _STUCK else _Known()
        self._beside = None

    def _tracked(self, point: OperatingPoint) -> Tracked:
        """What there is to say about a point."""
        solution, place = point.solution, point.place
        others = self._guide.others(solution.speed, place, solution.eccentricity_max)
        if (self.current or self.trusted) and place and not others:
            self._learn(settled=True)
        known = place is not None and (self.settled or not others)
        name = branch_name(solution, others) if known else BranchName.UNKNOWN
        other = self._solved_beside(others[0]) if place and others else None
        return Tracked(solution, name, point.jumped, point.stable, place, self.current, other)

    def _solved_beside(self, place: Place) -> Solution | None:
        """The other stable response."""
        beside, known = self._beside or (None, None)
        if beside and not known and place.is_at(beside):
            return None  # it is not sought again and again where an outdated curve is wrong
        self._beside = place, self._guide.solved(place, beside, known)
        return self._beside[1]

    def _learn(self, **changes: Any) -> None:
        """Change what is known."""
        self._known = self._known._replace(**changes)

    def _replaced(self, known: _Known) -> _Known:
        """What was known, with its place on the curve of now."""
        if known.last is None:
            return known
        place = self._guide.match(known.last.solution)
        return known._replace(last=known.last._replace(place=place))
