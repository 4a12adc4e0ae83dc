"""Zeros of functions whose zeros are known, in few evaluations."""

import math
import random
from collections.abc import Callable

import pytest

from sfd_hbm_ros.hbm.bracketing import zero_between

ACCURACY = 1e-6
Function = Callable[[float], float]
CASES: list[tuple[Function, float, float, float]] = [
    (lambda x: 3.0 * x - 1.0, 0.0, 1.0, 1.0 / 3.0),
    (lambda x: x * x - 2.0, 0.0, 2.0, math.sqrt(2.0)),
    (lambda x: math.exp(x) - 2.0, -4.0, 3.0, math.log(2.0)),
    (lambda x: math.tanh(30.0 * (x - 0.3)), 0.0, 1.0, 0.3),
    (lambda x: (x - 1.0) ** 3, 0.0, 3.0, 1.0),
    (lambda x: math.copysign(1.0, x - 0.123), 0.0, 1.0, 0.123),
    (lambda x: x, 0.0, 1.0, 0.0),
    (lambda x: x - 1.0, 0.0, 1.0, 1.0),
]


@pytest.mark.parametrize(("function", "start", "end", "zero"), CASES)
def test_zero_is_found(function: Function, start: float, end: float, zero: float) -> None:
    """From either side, in hardly more evaluations than bisection takes."""
    for one, other in ((start, end), (end, start)):
        asked: list[float] = []

        def counted(x: float, asked: list[float] = asked) -> float:
            asked.append(x)
            return function(x)

        assert zero_between(counted, one, other, ACCURACY) == pytest.approx(zero, abs=ACCURACY)
        assert all(min(start, end) <= x <= max(start, end) for x in asked)
        assert len(asked) <= 2 + 1.3 * math.log2((end - start) / ACCURACY)


def test_smooth_function_takes_few_evaluations() -> None:
    """Two at the ends, and a few of the kind that doubles the digits."""
    asked: list[float] = []

    def cosine(x: float) -> float:
        asked.append(x)
        return math.cos(x)

    assert zero_between(cosine, 1.0, 2.0, ACCURACY) == pytest.approx(0.5 * math.pi, abs=ACCURACY)
    assert len(asked) <= 7


def test_function_that_does_not_change_its_sign_is_refused() -> None:
    with pytest.raises(ArithmeticError, match="does not change its sign"):
        zero_between(math.exp, 0.0, 1.0, ACCURACY)


def test_accuracy_finer_than_numbers_are_ends_at_their_resolution() -> None:
    found = zero_between(lambda x: math.copysign(1.0, x - math.pi), 3.0, 4.0, 1e-30)
    assert found == pytest.approx(math.pi, abs=1e-15)


def test_function_without_a_value_is_refused() -> None:
    with pytest.raises(ArithmeticError, match="no value"):
        zero_between(lambda x: x if abs(x) == 1.0 else math.nan, -1.0, 1.0, ACCURACY)


def test_number_of_steps_is_bounded_for_a_function_made_to_delay_it() -> None:
    """Neither smooth nor the same twice, so that what is interpolated is always off."""
    rng = random.Random(1)
    for _ in range(200):
        powers = [rng.choice([1, 3, 9, 20]) for _ in range(2)]
        zero, asked = rng.uniform(-1.0, 1.0), 0

        def function(x: float, zero: float = zero, powers: list[int] = powers) -> float:
            nonlocal asked
            asked += 1
            power = powers[x > zero]
            return math.copysign(abs(x - zero) ** power * 10.0 ** rng.uniform(-8, 8), x - zero)

        found = zero_between(function, -1.0, 1.0, 1e-12)
        assert found == pytest.approx(zero, abs=1e-12)
        assert asked <= 2 + 3 * math.ceil(math.log2(2e12))
