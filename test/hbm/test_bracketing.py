"""Zeros of functions whose zeros are known, in few evaluations."""

import math
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
