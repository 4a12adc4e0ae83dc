"""The work on one variant: its response curve, and what an engineer reads off it."""

import time
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, get_args, get_type_hints

import numpy as np

from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.machine import Machine, MachineError, override_all
from sfd_hbm_ros.response.curves.accuracy import balance_for_speeds
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.detached import detached_branches
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.curves.multiplicity import locked_up, several_stable, stable_responses
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.responses import Response, vibration
from sfd_hbm_ros.threads import one_blas_thread


@dataclass(frozen=True)
class Outcome:
    """What became of a variant.

    Attributes
    ----------
    run_up, coast_down : float or None
        Speeds of the first jump of a run-up and of a coast-down [rad/s]; None where there is none.
    width : float or None
        Width of the hysteresis, between the two [rad/s].
    peak_speed, peak_eccentricity : float or None
        The stable response of the greatest eccentricity; speed in [rad/s].
    seconds : float
        Time that it took [s].
    reason : str
        Why there is no solution, or why the curve is incomplete; empty for a whole curve.
    peak_vibration : float or None
        Vibration there of the damper's journal that vibrates most, zero to peak, of its clearance.
    several_from, several_to : float or None
        Lowest and highest speed [rad/s] at which there is more than one stable response; None
        where there is one at most.
    detached : int or None
        Branches with a stable response that neither a run-up nor a coast-down meets; None where
        they were not looked for.
    locked_up : bool or None
        Whether a run-up ends on the upper one of several responses, as the film has locked up.
    responses : int or None
        Number of stable responses at the operating speed; None where there is no such speed.
    worst_vibration, best_vibration : float or None
        Greatest and least vibration of these, each of the damper's journal that vibrates most,
        zero to peak, of its clearance.
    worst_eccentricity, best_eccentricity : float or None
        Greatest and least eccentricity of these.
    """

    run_up: float | None
    coast_down: float | None
    width: float | None
    peak_speed: float | None
    peak_eccentricity: float | None
    seconds: float
    reason: str
    peak_vibration: float | None = None
    several_from: float | None = None
    several_to: float | None = None
    detached: int | None = None
    locked_up: bool | None = None
    responses: int | None = None
    worst_vibration: float | None = None
    best_vibration: float | None = None
    worst_eccentricity: float | None = None
    best_eccentricity: float | None = None


def outcome_from(data: Mapping[str, Any]) -> Outcome:
    """The outcome of the data that `dataclasses.asdict` made of it.

    Raises
    ------
    TypeError
        If it is none.
    """
    outcome = Outcome(**data)
    for field in fields(Outcome):
        value = getattr(outcome, field.name)
        kinds = get_args(_KINDS[field.name]) or (_KINDS[field.name],)
        if type(value) not in kinds and not (type(value) is int and float in kinds):
            raise TypeError(f"{field.name}: {value!r}")
    return outcome


_KINDS = get_type_hints(Outcome)


@dataclass(frozen=True)
class Task:
    """How the variants of a machine are computed; it is what worker processes are handed.

    Parameters
    ----------
    machine : Machine
        The machine.
    paths : tuple of str
        Dotted paths of the entries that vary.
    lowest, highest : float
        Range of the speed [rad/s].
    harmonics : HarmonicsOptions
        How many harmonics are taken, of each variant as many as it needs.
    operating : float or None
        Speed at which the responses are counted [rad/s].
    detached : bool
        Whether detached branches are looked for: from the operating speed, the ends of the range
        and the speeds just below the criticals of the shaft with its journals held.
    """

    machine: Machine
    paths: tuple[str, ...]
    lowest: float
    highest: float
    harmonics: HarmonicsOptions
    operating: float | None = None
    detached: bool = True

    @one_blas_thread
    def outcome(self, values: Sequence[float]) -> Outcome:
        """Compute the variant that has these values of the entries; nothing is raised."""
        started = time.perf_counter()
        try:
            return self._read_off(Summary(self._curve(values)), started)
        except NoSolutionError as error:
            return _failed(started, str(error))
        except (ArithmeticError, np.linalg.LinAlgError, MachineError) as error:
            return _failed(started, f"no solution: {error}")
        except Exception as error:  # one odd variant must not end a study of thousands
            frame = traceback.extract_tb(error.__traceback__)[-1]
            place = f"{Path(frame.filename).name}:{frame.lineno}"
            problem = f"an error of the program itself, {type(error).__name__} at {place}: {error}"
            return _failed(started, problem)

    def _curve(self, values: Sequence[float]) -> ResponseCurve:
        variant = override_all(self.machine, dict(zip(self.paths, values, strict=True)))
        speeds = self.lowest, self.highest
        curve = response_curve(balance_for_speeds(variant, *speeds, self.harmonics), *speeds)
        if not self.detached:
            return curve
        looked_at = [*speeds, *([] if self.operating is None else [self.operating])]
        return replace(curve, detached=tuple(detached_branches(curve, *speeds, looked_at)))

    def _read_off(self, summary: Summary, started: float) -> Outcome:
        curve = summary.curve
        first = {jump.direction: jump.value for jump in reversed(summary.jumps)}
        peak = summary.peak
        anywhere_stable = bool(np.isfinite(peak.value))
        several = several_stable(curve)
        there = [] if self.operating is None else stable_responses(curve, self.operating)
        vibrations = sorted(map(_vibration, there))
        cut_short = [
            branch.stop.value
            for branch in curve.branches
            if branch.stop in (Stop.STEP, Stop.POINTS, Stop.ARC, Stop.PROGRESS)
        ]
        return Outcome(
            run_up=first.get(Direction.RUN_UP),
            coast_down=first.get(Direction.COAST_DOWN),
            width=summary.hysteresis,
            peak_speed=peak.value if anywhere_stable else None,
            peak_eccentricity=peak.eccentricity if anywhere_stable else None,
            seconds=time.perf_counter() - started,
            reason=(
                "; ".join(cut_short) if anywhere_stable else "no response in the range is stable"
            ),
            peak_vibration=_vibration(peak.response) if peak.response else None,
            several_from=several[0][0] if several else None,
            several_to=several[-1][1] if several else None,
            detached=(
                sum(bool(branch.stable.any()) for branch in curve.detached)
                if self.detached
                else None
            ),
            locked_up=locked_up(curve),
            responses=None if self.operating is None else len(there),
            worst_vibration=vibrations[-1] if there else None,
            best_vibration=vibrations[0] if there else None,
            worst_eccentricity=there[-1].eccentricity_max if there else None,
            best_eccentricity=there[0].eccentricity_max if there else None,
        )


def _vibration(response: Response) -> float:
    """Of the damper's journal that vibrates most, of its clearance."""
    return max(
        vibration(response, name) / motion.clearance for name, motion in response.journals.items()
    )


def _failed(started: float, reason: str) -> Outcome:
    return Outcome(None, None, None, None, None, time.perf_counter() - started, reason)
