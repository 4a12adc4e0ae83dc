"""Measured orbits settle the branch: at once where it is open, only together where it is known."""

import pytest

from sfd_hbm_ros.response.tracking.settling import CONFIRMATIONS, Settling
from sfd_hbm_ros.response.tracking.tracked import Tracked

from .test_measured import orbit, responses


@pytest.fixture(params=[0, 1], ids=["upper", "lower"])
def own(request):
    return request.param


@pytest.fixture
def tracked(own):
    return Tracked(responses()[own], other=responses()[1 - own])


def test_one_orbit_settles_an_open_branch(own, tracked):
    same = Settling().judge(orbit(own), tracked, settled=False)
    assert same.settles is tracked.solution
    assert same.agreement.disagreement == pytest.approx(0.0, abs=1e-12)
    different = Settling().judge(orbit(1 - own), tracked, settled=False)
    assert different.settles is tracked.other
    assert different.agreement.disagreement == pytest.approx(0.0, abs=1e-12)


def test_what_the_history_tells_needs_no_settling(own, tracked):
    assert Settling().judge(orbit(own), tracked, settled=True).settles is None


def test_a_known_branch_is_left_only_after_several_orbits_in_a_row(own, tracked):
    settling = Settling()

    def judged(which):
        return settling.judge(orbit(which), tracked, settled=True)

    for _ in range(CONFIRMATIONS - 1):
        contrary = judged(1 - own)
        assert contrary.settles is None
        assert contrary.agreement.disagreement > 0.3  # against the branch it is held to be on
        assert "the other branch" in contrary.message
    assert judged(own).settles is None  # begins the count anew
    settled = [judged(1 - own).settles for _ in range(CONFIRMATIONS)]
    assert settled == [None] * (CONFIRMATIONS - 1) + [tracked.other]


def test_nothing_is_settled_without_another_response(own, tracked):
    alone = Tracked(tracked.solution)
    for settled in (False, True):
        assert Settling().judge(orbit(own), alone, settled).settles is None
        assert Settling().judge(orbit(1 - own), alone, settled).settles is None


def test_an_orbit_between_both_settles_nothing(tracked):
    upper, lower = orbit(0), orbit(1)
    between = {
        name: 0.5 * (upper[name] + lower[name]) for name in upper if name.endswith("/amplitude")
    }
    assert Settling().judge(between, tracked, settled=False).settles is None
