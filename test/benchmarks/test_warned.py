"""The runs before which the warning is judged, their jumps, and what counts as what."""

import sys
from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.warned import main, outcome, score, warnings
from benchmarks.warned_in_time import CIRCLES, jump_in_time
from benchmarks.warned_run import random_run
from sfd_hbm_ros.response.curves.journey import travel
from sfd_hbm_ros.response.curves.place import response_on
from sfd_hbm_ros.response.integration.observed import observed_jumps
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import simulate

STEEP, JUMPING = 15, 20  # a run-up without a fold, and a coast-down through one
GRADUAL = 151  # a coast-down that leaves its response over a second


@cache
def case(number):
    return random_run(np.random.default_rng([1, number]))


def shorter(run, start, end, rate):
    """A part of a run."""
    place = travel(run.curve, run.first, start).place
    return replace(run, place=place, ramp=Ramp.between(start, end, rate))


def test_a_run_is_that_of_its_number():
    again = random_run(np.random.default_rng([1, STEEP]))
    assert again.ramp == case(STEEP).ramp
    assert again.curve.balance.machine == case(STEEP).curve.balance.machine
    assert again.curve.balance.machine != case(JUMPING).curve.balance.machine


def test_a_steep_flank_is_no_jump():
    """Though it looks like one at this rate: the machine goes back along it."""
    run = shorter(case(STEEP), 715.0, 742.0, 14.0)
    looked_at = simulate(run.curve.balance, 715.0, 742.0, 14.0, CIRCLES)
    assert len(observed_jumps(looked_at)) == 1
    assert jump_in_time(run) == np.inf


def test_a_jump_comes_soon_after_the_fold():
    """A slow passage delays it by some tenths of a second, and nothing brings it forward."""
    run = case(JUMPING)
    rate = abs(run.ramp.acceleration)
    run = shorter(run, run.fold + 1.5 * rate, run.fold - 3.0 * rate, rate)
    assert 1.5 < jump_in_time(run) < 2.5


def test_a_gradual_passage_is_a_jump_where_the_fold_is_if_it_is_not_undone():
    run = case(GRADUAL)
    rate = abs(run.ramp.acceleration)
    run = shorter(run, run.fold + rate, run.fold - 3.0 * rate, rate)
    looked_at = simulate(run.curve.balance, run.fold + rate, run.fold - 3.0 * rate, rate, CIRCLES)
    assert observed_jumps(looked_at) == []
    assert jump_in_time(run) == pytest.approx(1.0, abs=0.01)


def test_the_warning_comes_when_it_was_configured():
    """2.5 s before the fold, and the on-delay of 0.1 s and the period of the speeds later."""
    run = case(JUMPING)
    [rose, *_] = warnings(run, run.time(run.fold), np.random.default_rng(5))
    assert run.time(run.fold) - rose == pytest.approx(2.4, abs=0.1)


def test_it_begins_with_a_converged_response():
    for number in (STEEP, JUMPING):
        assert response_on(case(number).first) is not None
        assert case(number).first.stable_orbit


@pytest.mark.parametrize(
    ("jump", "changes", "verdict"),
    [
        (4.6, [1.5], "warned"),
        (4.6, [1.5, 4.0], "warned, gone"),
        (4.6, [2.7], "missed"),
        (4.6, [], "missed"),
        (4.6, [1.0, 2.0, 3.0], "chatter"),
        (np.inf, [1.5], "false warning"),
        (np.inf, [], "rightly silent"),
    ],
)
def test_what_counts_as_what(jump, changes, verdict):
    assert outcome(case(JUMPING), jump, changes).verdict == verdict


def test_a_fold_that_is_not_seen_in_time_is_not_judged_where_nothing_was_to_be_seen():
    slight, unknown = (replace(case(JUMPING), change=change) for change in (0.01, np.nan))
    assert outcome(slight, np.inf, [1.5]).verdict == "not judged: too slight a jump"
    assert outcome(unknown, np.inf, [1.5]).verdict == "not judged: unknown jump"


def test_score():
    counts = Counter(
        {"warned": 95, "warned, gone": 3, "missed": 1, "chatter": 1, "rightly silent": 49}
    )
    counts.update({"false warning": 1, "not judged: no solution": 3})
    *table, jumps, quiet = score(counts)
    assert table[0].split() == ["95", "warned"]
    assert jumps == "100 jumps, 98.0 % of them warned of at least 2 s ahead"
    assert quiet == "50 runs without a jump, 1 of them with a warning"


@pytest.mark.parametrize("choice", ["--runs=0", "--first=-1", "--seed=-1"])
def test_numbers_that_are_not_allowed_are_refused(monkeypatch, capsys, choice):
    monkeypatch.setattr(sys, "argv", ["warned", choice])
    with pytest.raises(SystemExit) as refused:
        main()
    assert refused.value.code == 2
    name, value = choice.split("=")
    assert f"{name}: {value} is not allowed, at least" in capsys.readouterr().err
