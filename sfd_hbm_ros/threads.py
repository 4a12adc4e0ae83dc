"""One BLAS thread where matrices are small, whatever else the process does with BLAS.

A rotor that is condensed to its dampers has matrices of ten to some hundred rows. More threads
than one only wait for one another there, and the longer the busier the computer is: a curve of one
second takes half a minute beside two busy processes. Environment variables would limit the threads
too late where NumPy has been imported before, and for good. Here they are limited while something
small is at work, and then as many as before.

NumPy and SciPy each bring an OpenBLAS of their own from PyPI, and share one as Ubuntu's packages.
"""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Callable
from contextlib import ContextDecorator
from functools import cache
from typing import NamedTuple

_NAMES = [  # Ubuntu's, those of the wheels of NumPy and SciPy, and those with long integers
    f"{prefix}openblas_%s_num_threads{suffix}"
    for prefix in ("", "scipy_")
    for suffix in ("", "64_", "_64")
]


class _Library(NamedTuple):
    """The number of threads of one BLAS library."""

    get: Callable[[], int]
    set: Callable[[int], object]


class _OneBlasThread(ContextDecorator):
    """Limits the threads from the first entry to the last exit, in whichever threads they are.

    An entry within another one takes a microsecond, the first one some ten.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._entries = 0
        self._before: list[int] = []

    def __enter__(self) -> None:
        with self._lock:
            if self._entries == 0:
                self._before = [library.get() for library in _libraries()]
                for library in _libraries():
                    library.set(1)
            self._entries += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._entries -= 1
            if self._entries == 0:
                for library, threads in zip(_libraries(), self._before, strict=True):
                    library.set(threads)


one_blas_thread = _OneBlasThread()
"""Context and decorator: within, NumPy and SciPy use one BLAS thread each."""


@cache
def _libraries() -> tuple[_Library, ...]:
    """Return the OpenBLAS libraries of NumPy and SciPy; none where the system shows none."""
    import scipy.linalg.lapack  # noqa: F401 - it and NumPy load them

    found: dict[int, _Library] = {}
    for path in _loaded():
        try:
            handle = ctypes.CDLL(path, mode=os.RTLD_NOW | os.RTLD_NOLOAD)
        except OSError:  # its file has been replaced since
            continue
        for name in _NAMES:
            get_threads = getattr(handle, name % "get", None)
            set_threads = getattr(handle, name % "set", None)
            if set_threads is not None and get_threads is not None:
                set_threads.argtypes, set_threads.restype = [ctypes.c_int], None
                address = ctypes.cast(set_threads, ctypes.c_void_p).value or 0
                found[address] = _Library(get_threads, set_threads)  # Ubuntu's has two names
    return tuple(found.values())


def _loaded() -> list[str]:
    """Return the paths of the BLAS libraries that this process has loaded, Linux's way."""
    try:
        with open("/proc/self/maps", encoding="utf-8", errors="surrogateescape") as file:
            paths = {line.rstrip("\n").partition("/")[2] for line in file}
    except OSError:
        return []
    return sorted(f"/{path}" for path in paths if "blas" in os.path.basename(path))
