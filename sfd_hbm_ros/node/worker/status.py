"""How the worker process fares, for the diagnostics."""

from __future__ import annotations

from dataclasses import replace

from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.worker.worker import Worker
from sfd_hbm_ros.response.warning.settings import Level


def with_worker(model: Status, worker: Worker) -> Status:
    """Return the status of the model with how its response curve and the worker process fare."""
    values = {
        "worker: points": str(worker.points),
        "worker: process": str(worker.pid or "none"),
        "worker: replacements": str(worker.replacements),
    }
    if worker.problem:
        values["worker: last problem"] = worker.problem
    level, words = _told(worker)
    return replace(
        model,
        level=max(model.level, level),
        message="; ".join(part for part in (model.message, words) if part),
        values={**model.values, **values},
    )


def _told(worker: Worker) -> tuple[Level, str]:
    """Return how bad it is, and the same in words where there is something to tell."""
    if worker.failed:
        return Level.ERROR, f"there is no new response curve: {worker.problem}"
    if worker.failures:
        attempts = f"{worker.failures} of {worker.patience.attempts} attempts have failed"
        return Level.WARN, f"{attempts}, the next follows: {worker.problem}"
    if worker.job is not None:
        return Level.OK, f"the response curve is being computed, {worker.points} points so far"
    return Level.OK, ""
