"""The numbers of BLAS threads of this process, asked of the libraries themselves."""

import ctypes
import re


def blas_threads() -> set[int]:
    """Those of all OpenBLAS libraries that are loaded."""
    with open("/proc/self/maps", encoding="utf-8") as file:
        paths = set(re.findall(r"/\S*openblas\S*", file.read()))
    found = set()
    for path in paths:
        library = ctypes.CDLL(path)
        for name in (
            "openblas_get_num_threads",
            "openblas_get_num_threads64_",
            "scipy_openblas_get_num_threads",
            "scipy_openblas_get_num_threads64_",
        ):
            if hasattr(library, name):
                found.add(getattr(library, name)())
    return found
