"""Types of arrays."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

RealArray: TypeAlias = NDArray[np.float64]
ComplexArray: TypeAlias = NDArray[np.complex128]
IndexArray: TypeAlias = NDArray[np.intp]
NumberArray: TypeAlias = NDArray[np.inexact[Any]]
"""Real or complex."""
SparseArray: TypeAlias = csr_array
"""Real or complex, stored by rows."""
