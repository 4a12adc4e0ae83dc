"""Compilation of numerical kernels to machine code by Numba, kept on disk between processes.

A kernel is compiled, or loaded from disk, at its first call: what calls none, such as a list of
critical speeds, does without Numba, which takes longer to import than all the rest together.

Numba compiles a kernel anew when the kernel's own file has changed, not when another one has. All
that a kernel calls therefore stands in its file.

Where Numba cannot be imported Python runs the same kernels, with the same results up to rounding.
"""

from __future__ import annotations

import gc
import math
import os
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, wraps
from types import FunctionType, SimpleNamespace
from typing import Any, TypeVar

import numpy as np

Function = TypeVar("Function", bound=Callable[..., Any])

_PARTS: defaultdict[str, list[Callable[..., Any]]] = defaultdict(list)  # by module, not compiled
_LOADERS: list[Callable[[], object]] = []  # of all kernels
_SAID = "SFD_HBM_ROS_UNCOMPILED_SAID"  # in the environment of a process and of its children
_SLOWER = "10 to 40"  # times: a curve and a solution without Numba, as measured


class UncompiledWarning(UserWarning):
    """Numba cannot be imported, and so the kernels are slow."""


@cache
def why_uncompiled() -> str | None:
    """Return a sentence about kernels that cannot be compiled; None where they can be."""
    try:
        import numba  # noqa: F401
    except ImportError as error:
        reason = " ".join(str(error).split())
        return (
            f"Numba cannot be imported ({reason}), so the numerical kernels run uncompiled, some "
            f"{_SLOWER} times slower; install it with 'apt install python3-numba' or "
            "'pip install numba'"
        )
    return None


def warn_if_uncompiled() -> None:
    """Warn of slow kernels, once for a process and all that it starts.

    A process that starts others calls this before, so that they need not say it, too.
    """
    sentence = why_uncompiled()
    if sentence is not None and _SAID not in os.environ:
        os.environ[_SAID] = "1"
        warnings.warn(sentence, UncompiledWarning, stacklevel=2)


def kernel(signature: str) -> Callable[[Function], Function]:
    """Decorate a function that Python calls.

    Compiled code is kept beside the source, or else in the user's cache or in the folder that
    the environment variable NUMBA_CACHE_DIR names. Where none can be written to, every process
    compiles for itself.

    Parameters
    ----------
    signature : str
        Types of the arguments and of the result, as Numba writes them: one signature, so that
        nothing is compiled later.
    """

    def decorated(function: Function) -> Any:
        compiled: Function | None = None

        def load() -> Function:
            nonlocal compiled
            if compiled is None:
                compiled = _compiled(function, signature)
            return compiled

        @wraps(function)
        def call(*arguments: Any) -> Any:
            return (compiled or load())(*arguments)

        _LOADERS.append(load)
        return call

    return decorated


def part(function: Function) -> Function:
    """Decorate a function that kernels of the same file call."""
    _PARTS[function.__module__].append(function)
    return function


def load_kernels() -> None:
    """Compile, or load from disk, the kernels of all modules imported so far.

    For a process that has time now, and none once it is at work: the garbage collector will not
    look again at what there is now, which would take it a tenth of a second at any moment.
    """
    for load in _LOADERS:
        load()
    gc.collect()
    gc.freeze()


def _compiled(function: Function, signature: str) -> Function:
    """The machine code of a kernel, or the kernel for Python where there is no Numba."""
    with _no_garbage_collection():
        if why_uncompiled() is not None:
            warn_if_uncompiled()
            return _interpreted(function)
        # Numba takes a function's callees from the globals of its module.
        for one in _PARTS.pop(function.__module__, []):
            function.__globals__[one.__name__] = _jit(one)
        try:
            return _jit(function, signature, cache=True)
        except RuntimeError as error:
            if "no locator" not in str(error):
                raise
            return _jit(function, signature)


def _interpreted(function: Function) -> Function:
    """A kernel that Python runs with the arithmetic of machine code.

    There a division by zero has a result, where Python's own numbers raise an exception: all
    numbers are NumPy's, and so are the functions of numbers.
    """
    names = {**function.__globals__, "math": _MATH, "complex": _complex}
    for one in _PARTS[function.__module__]:
        names[one.__name__] = FunctionType(one.__code__, names)
    interpreted = FunctionType(function.__code__, names)

    @wraps(function)
    def run(*arguments: Any) -> Any:
        numbers = (np.float64(one) if isinstance(one, float) else one for one in arguments)
        with np.errstate(all="ignore"):
            return interpreted(*numbers)

    return run  # type: ignore[return-value]


def _complex(real: Any, imag: Any = 0.0) -> Any:
    return np.complex128(complex(real, imag))


_MATH = SimpleNamespace(
    **{name: getattr(np, name) for name in ("cos", "sin", "sqrt", "log", "hypot", "floor")},
    atan2=np.arctan2,
    isfinite=np.isfinite,
    pi=np.float64(math.pi),
    nan=np.float64(math.nan),
)
"""What kernels use of `math`."""


def _jit(function: Function, signature: str | None = None, cache: bool = False) -> Function:
    import numba

    jit: Callable[..., Callable[[Function], Function]] = numba.jit
    return jit(signature, cache=cache, nopython=True, error_model="numpy")(function)


@contextmanager
def _no_garbage_collection() -> Iterator[None]:
    """Spare the collector the hundred thousand objects that Numba makes as it loads, and keeps."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if gc.get_freeze_count() == 0:  # else others would be thawed with them
            gc.freeze()
            gc.unfreeze()  # from which they come back as old
        if enabled:
            gc.enable()
