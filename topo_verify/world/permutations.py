"""Trusted: vertices and faces are cycles of permutations."""

from __future__ import annotations

from collections.abc import Sequence


def cycles(permutation: Sequence[int], starts: Sequence[int] = ()) -> tuple[tuple[int, ...], ...]:
    """The cycles, in the order of their starts; those without one by their least dart."""
    visited = [False] * len(permutation)
    cycles: list[tuple[int, ...]] = []
    for start in (*starts, *range(len(permutation))):
        cycle: list[int] = []
        dart = start
        while not visited[dart]:
            visited[dart] = True
            cycle.append(dart)
            dart = permutation[dart]
        if cycle:
            cycles.append(tuple(cycle))
    return tuple(cycles)
