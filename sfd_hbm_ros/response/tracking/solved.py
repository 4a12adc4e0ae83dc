"""One run of Newton's method from a start that is near."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import Equations, NewtonOptions, Solution
from sfd_hbm_ros.hbm.newton import newton
from sfd_hbm_ros.hbm.solve import solution_at
from sfd_hbm_ros.response.responses import balanced

Array = NDArray[np.float64]


def solved(equations: Equations, x: Array, options: NewtonOptions) -> Solution | None:
    """The solution to which Newton's method leads, with the history of its residual.

    Parameters
    ----------
    equations : Equations
        The machine at one speed.
    x : (rows n,) array
        Coefficients from which it starts [m].
    options : NewtonOptions
        Tolerance and limits.
    """
    result = newton(equations, x, options)
    if not balanced(equations, result):
        return None
    solution = solution_at(equations.balance, equations.speed, result.x)
    return replace(solution, residuals=result.residuals)
