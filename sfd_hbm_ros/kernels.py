"""Compilation of numerical kernels to machine code by Numba, kept on disk between processes.

A kernel is compiled, or loaded from disk, at its first call: what calls none, such as a list of
critical speeds, does without Numba, which takes longer to import than all the rest together.

Numba compiles a kernel anew when the kernel's own file has changed, not when another one has. All
that a kernel calls therefore stands in its file.
"""

from __future__ import annotations

import gc
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

_PARTS: defaultdict[str, list[Callable[..., Any]]] = defaultdict(list)  # by module, not compiled
_LOADERS: list[Callable[[], object]] = []  # of all kernels


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
    """The machine code of a kernel."""
    with _no_garbage_collection():
        # Numba takes a function's callees from the globals of its module.
        for one in _PARTS.pop(function.__module__, []):
            function.__globals__[one.__name__] = _jit(one)
        try:
            return _jit(function, signature, cache=True)
        except RuntimeError as error:
            if "no locator" not in str(error):
                raise
            return _jit(function, signature)


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
