"""How the kernel is compiled, and its arrays as type checkers see them: integers by integers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

import numba
import numpy as np

F = TypeVar("F", bound=Callable[..., object])

if TYPE_CHECKING:

    class Ints(Protocol):
        """An array of int64, of any shape."""

        def __getitem__(self, key: Any, /) -> int:
            """One number (or, for a slice, a part of the array)."""
            ...

        def __setitem__(self, key: Any, value: object, /) -> None:
            """Put a number at a place, or in each of a slice."""
            ...

    def compiled(function: F) -> F:
        """Return the function as numba compiles it."""
        return function

else:
    Ints = np.ndarray
    compiled = numba.njit(cache=True)


def ints(*shape: int, fill: int = 0) -> Ints:
    """An array of this shape with the same number everywhere."""
    return cast("Ints", np.full(shape, fill, np.int64))
