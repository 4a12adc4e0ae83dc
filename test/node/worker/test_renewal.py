"""When a curve is computed anew, and for which loads."""

import numpy as np
import pytest

from sfd_hbm_ros.node.worker.renewal import LONGEST, QUIET, MeanLoads, Renewal


def computed(changes: list[float], duration: float, end: float) -> list[tuple[float, float]]:
    """Begin and end of the computations that were not interrupted, looked for each 10 ms."""
    renewal, begun, found = Renewal(), None, []
    waiting = sorted(changes)
    for now in np.arange(0.0, end, 0.01).tolist():
        while waiting and waiting[0] <= now:
            renewal.change(waiting.pop(0))
        if begun is not None and now >= begun + duration:
            found.append((begun, now))
            begun = None
        if renewal.due(now, busy=begun is not None):
            begun = now
    return found


def test_without_a_change_nothing_is_computed():
    assert computed([], 1.0, 20.0) == []


def test_the_first_computation_waits_for_nothing():
    renewal = Renewal()
    renewal.change(7.0, first=True)
    assert renewal.due(7.0, busy=False)
    assert not renewal.due(7.01, busy=True)
    renewal.change(8.0)
    assert not renewal.due(8.0 + 0.5 * QUIET, busy=False)
    assert renewal.due(8.01 + QUIET, busy=False)


def test_it_begins_soon_after_the_last_of_several_changes():
    [(begun, _)] = computed([1.0, 1.2, 1.4], 1.0, 20.0)
    assert begun == pytest.approx(1.4 + QUIET, abs=0.02)


def test_a_change_interrupts_and_is_computed():
    [(begun, ended)] = computed([0.0, 2.0], 10.0, 30.0)
    assert begun == pytest.approx(2.0 + QUIET, abs=0.02)
    assert ended == pytest.approx(begun + 10.0, abs=0.02)


@pytest.mark.parametrize("distance", [0.1, 0.7], ids=["without a pause", "with pauses"])
@pytest.mark.parametrize("duration", [0.3, 3.0, 12.0])
def test_changes_that_never_end_starve_no_computation(distance, duration):
    changes = np.arange(0.0, 60.0, distance).tolist()
    found = computed(changes, duration, 60.0)
    begins = np.array([0.0, *(begun for begun, _ in found)])
    assert np.diff(begins).max() <= LONGEST + max(QUIET, duration) + 0.05
    assert len(found) >= 60.0 / (2.0 * LONGEST + duration) - 1


def test_the_last_change_is_never_forgotten():
    for last in np.arange(0.1, 12.0, 0.37).tolist():
        found = computed([0.0, last / 2.0, last], 4.0, 40.0)
        assert found[-1][0] >= last


def test_the_mean_of_loads_is_that_of_what_came():
    mean = MeanLoads()
    latest = {"disk_1": (1.0, -2.0)}
    assert mean.forces(latest) == latest
    mean.add({"disk_1": (0.1, 0.0)})
    assert mean.forces(latest) == {"disk_1": (0.1, 0.0)}  # to the last digit
    mean.add({"disk_1": (0.3, -6.0)})
    assert mean.forces(latest) == {"disk_1": pytest.approx((0.2, -3.0))}
    mean.add({"disk_1": (5.0, 0.0), "disk_2": (7.0, 1.0)})  # a station more begins anew
    assert mean.forces(latest) == {"disk_1": (5.0, 0.0), "disk_2": (7.0, 1.0)}
