"""Compilation of numerical kernels to machine code by Numba, kept on disk between processes.

Numba compiles a kernel anew when the kernel's own file has changed, not when another one has. All
that a kernel calls therefore stands in its file.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])


def kernel(signature: str) -> Callable[[Function], Function]:
    """Decorate a function that Python calls; it is compiled, or loaded from disk, at once.

    Compiled code is kept beside the source, or else in the user's cache or in the folder that
    the environment variable NUMBA_CACHE_DIR names. Where none can be written to, every process
    compiles for itself.

    Parameters
    ----------
    signature : str
        Types of the arguments and of the result, as Numba writes them: one signature, so that
        nothing is compiled later.
    """

    def compiled(function: Function) -> Function:
        try:
            return _compiled(function, signature, cache=True)
        except RuntimeError as error:
            if "no locator" not in str(error):
                raise
            return _compiled(function, signature, cache=False)

    return compiled


def part(function: Function) -> Function:
    """Decorate a function that kernels of the same file call."""
    return _compiled(function, None, cache=False)


def _compiled(function: Function, signature: str | None, cache: bool) -> Function:
    jit: Callable[..., Callable[[Function], Function]] = numba.jit
    return jit(signature, cache=cache, nopython=True, error_model="numpy")(function)
