"""The work on one variant: its response curve, and what an engineer reads off it."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, get_args, get_type_hints

import numpy as np

from sfd_hbm_ros.hbm.points import Stop
from sfd_hbm_ros.hbm.truncation import HarmonicsOptions
from sfd_hbm_ros.machine import Machine, override_all
from sfd_hbm_ros.response.curves.accuracy import balance_for_speeds
from sfd_hbm_ros.response.curves.curve import ResponseCurve, response_curve
from sfd_hbm_ros.response.curves.jumps import Direction
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.response.errors import NoSolutionError
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
    """

    run_up: float | None
    coast_down: float | None
    width: float | None
    peak_speed: float | None
    peak_eccentricity: float | None
    seconds: float
    reason: str


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
    """

    machine: Machine
    paths: tuple[str, ...]
    lowest: float
    highest: float
    harmonics: HarmonicsOptions

    @one_blas_thread
    def outcome(self, values: Sequence[float]) -> Outcome:
        """Compute the variant that has these values of the entries; nothing is raised."""
        started = time.perf_counter()
        try:
            summary = Summary(self._curve(values))
        except NoSolutionError as error:
            return _failed(started, str(error))
        except Exception as error:  # one odd variant must not end a study of thousands
            return _failed(started, f"{type(error).__name__}: {error}")
        return _read_off(summary, started)

    def _curve(self, values: Sequence[float]) -> ResponseCurve:
        variant = override_all(self.machine, dict(zip(self.paths, values, strict=True)))
        speeds = self.lowest, self.highest
        return response_curve(balance_for_speeds(variant, *speeds, self.harmonics), *speeds)


def _read_off(summary: Summary, started: float) -> Outcome:
    first = {jump.direction: jump.value for jump in reversed(summary.jumps)}
    peak = summary.peak
    anywhere_stable = bool(np.isfinite(peak.value))
    cut_short = [
        branch.stop.value
        for branch in summary.curve.branches
        if branch.stop in (Stop.STEP, Stop.POINTS)
    ]
    return Outcome(
        first.get(Direction.RUN_UP),
        first.get(Direction.COAST_DOWN),
        summary.hysteresis,
        peak.value if anywhere_stable else None,
        peak.eccentricity if anywhere_stable else None,
        time.perf_counter() - started,
        "; ".join(cut_short) if anywhere_stable else "no response in the range is stable",
    )


def _failed(started: float, reason: str) -> Outcome:
    return Outcome(None, None, None, None, None, time.perf_counter() - started, reason)
