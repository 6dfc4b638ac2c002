"""The cycles of a permutation. Trusted: vertices and faces are such cycles."""

from __future__ import annotations

from collections.abc import Sequence


def cycles(permutation: Sequence[int], starts: Sequence[int] = ()) -> tuple[tuple[int, ...], ...]:
    """The cycles, in the order of their starts; those without one by their least dart."""
    seen = [False] * len(permutation)
    cycles: list[tuple[int, ...]] = []
    for start in (*starts, *range(len(permutation))):
        cycle: list[int] = []
        dart = start
        while not seen[dart]:  # empty for a start that an earlier cycle went through
            seen[dart] = True
            cycle.append(dart)
            dart = permutation[dart]
        if cycle:
            cycles.append(tuple(cycle))
    return tuple(cycles)
