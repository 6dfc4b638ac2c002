"""Names for arrays, and sparse linear equations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


# pyright: reportMissingTypeStubs=false


FEW = 100
"""Up to this size NumPy is faster; SciPy loads slowly."""


def solve(rows: Ints, columns: Ints, values: Floats, right: Floats) -> Floats:
    """The solution of symmetric positive definite equations; repeated entries add up."""
    size = len(right)
    if size <= FEW:
        dense = np.bincount(rows * size + columns, values, size * size).reshape(size, size)
        return np.asarray(np.linalg.solve(dense, right), np.float64)
    from scipy.sparse import csc_matrix, linalg  # type: ignore[import-untyped]

    library: Any = linalg
    matrix: Any = csc_matrix((values, (rows, columns)), shape=(size, size))
    factors: Any = library.splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return np.asarray(factors.solve(right), np.float64)
