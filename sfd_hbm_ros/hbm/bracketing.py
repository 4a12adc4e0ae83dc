"""The zero of a function of one variable between two arguments at which its signs differ.

`scipy.optimize` would do as well, but takes longer to import than NumPy, and 20 MB of memory.
"""

import math
from collections.abc import Callable

_PATIENCE = 2  # steps for each halving that bisection would take, after which it bisects


def zero_between(
    function: Callable[[float], float], start: float, end: float, accuracy: float
) -> float:
    """Find a zero by inverse quadratic interpolation where that is safe, else by bisection.

    T. R. Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a
    nonlinear function without using derivatives, Advances in Engineering Software 28 (1997)
    145-149; the first step here is a secant's.

    Parameters
    ----------
    function : callable
        A continuous function.
    start, end : float
        Two arguments at which it has different signs, or is zero.
    accuracy : float
        Largest distance of the result from a zero.

    Raises
    ------
    ArithmeticError
        If the signs do not differ, or a value is not a number.
    """
    newest, f_newest = start, function(start)
    across, f_across = end, function(end)  # on the other side of the zero
    if f_newest == 0.0 or f_across == 0.0:
        return newest if f_newest == 0.0 else across
    if (f_newest > 0.0) == (f_across > 0.0):
        raise ArithmeticError("the function does not change its sign")
    part = f_newest / (f_newest - f_across)
    halvings = math.ceil(max(math.log2(abs(end - start)) - math.log2(accuracy), 1.0))
    for step in range((_PATIENCE + 1) * halvings):
        if newest + 0.5 * (across - newest) in (newest, across):
            break  # there is no number between them
        x = newest + part * (across - newest)
        f = function(x)
        if math.isnan(f):
            raise ArithmeticError("the function has no value")
        if (f > 0.0) == (f_newest > 0.0):
            left, f_left = newest, f_newest
        else:
            left, f_left = across, f_across
            across, f_across = newest, f_newest
        newest, f_newest = x, f
        nearest = 0.5 * accuracy / abs(across - newest)
        if f == 0.0 or nearest >= 0.5:
            break
        part = _interpolated(newest - across, left - across, f_newest, f_across, f_left)
        part = min(max(part, nearest), 1.0 - nearest) if step < _PATIENCE * halvings else 0.5
    return newest if abs(f_newest) < abs(f_across) else across


def _interpolated(newest: float, left: float, f: float, f_across: float, f_left: float) -> float:
    """Part of the way to the argument across, from which the others are counted here."""
    xi, phi = newest / left, (f - f_across) / (f_left - f_across)
    if not (phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi):
        return 0.5  # the inverse of the interpolating parabola would not be monotonic
    from_left = f / (f_across - f) * f_left / (f_across - f_left)
    return from_left - (left - newest) / newest * f / (f_left - f) * f_across / (f_left - f_across)
