"""Checks the arguments of families, and names their worlds."""

from __future__ import annotations

from contextlib import suppress
from operator import index
from random import Random
from typing import SupportsFloat, SupportsIndex

from topo_verify.errors import InputError
from topo_verify.world.rooted_map import Dart

MAX_DARTS = 10**6
"""Larger worlds take minutes and gigabytes."""


def integer(family: str, name: str, value: object, least: int) -> int:
    """The value as a plain int of at least `least`."""
    if isinstance(value, SupportsIndex) and not isinstance(value, bool) and index(value) >= least:
        return index(value)
    raise InputError(f"{family}: {name} is {value!r}, expected an integer of {least} or more")


def share(family: str, name: str, value: object, *, whole: bool) -> float:
    """The value as a plain float in 0 … 1; 1 only if `whole`."""
    if isinstance(value, SupportsFloat):
        # NaN fails the comparison
        with suppress(OverflowError):
            share = float(value)
            if 0 <= share < 1 or (whole and share == 1):
                return share
    expected = "a number from 0 to 1" if whole else "a number from 0 to below 1"
    raise InputError(f"{family}: {name} is {value!r}, expected {expected}")


def size(family: str, size: tuple[int, int], *, darts_each: int) -> tuple[int, int, int]:
    """The rows, the columns and the number of darts."""
    rows, columns = integer(family, "rows", size[0], 1), integer(family, "columns", size[1], 1)
    return rows, columns, darts_each * rows * columns


def settled(
    family: str,
    *places: float,
    darts: int,
    marker: Dart | None,
    seed: int = 0,
    holes: float = 0.0,
) -> tuple[str, Dart | None, Random]:
    """The world's name, the marker (None: to be drawn) and the source of all draws."""
    seed = integer(family, "seed", seed, 0)
    if darts > MAX_DARTS:
        raise InputError(
            f"{family}: so large a world might have more than {MAX_DARTS} darts (two an edge): ask"
            " for a smaller one"
        )
    marker = None if marker is None else integer(family, "marker", marker, 0)
    given = [f"{key}={value!r}" for key, value in (("holes", holes), ("seed", seed)) if value]
    given += [] if marker is None else [f"marker={marker}"]
    return f"{family}({','.join([*map(repr, places), *given])})", marker, Random(seed)
