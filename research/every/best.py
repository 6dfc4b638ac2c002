"""A cheapest and a most expensive run, from the tables of `kernel.py`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from research.every import kernel as k
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.world.rooted_map import Dart

RunOrder = tuple[tuple[Dart, ...], ...]
"""For each edge in turn: e, then the hypotheses tried, in darts of the world."""


class Tables:
    """The arrays that the kernel reads and fills, kept for the life of the process."""

    def __init__(self) -> None:
        self.world = _ints(5, k.MOST_DARTS)
        self.found = _ints(6)
        self._work = _ints(4, 4 * k.ROOM, fill=-1)
        self._cost = _ints(k.ROOM, k.VERTICES, 2)
        self._low = _ints(k.ROOM, k.MOST_DARTS, 3)
        self._darts = _ints(k.MOST_DARTS)
        self._row = _ints(k.MOST_DARTS, 3 * k.MOST_DARTS + 3)
        self._kills = _ints(k.MOST_DARTS)
        self._best = _ints((1 << k.MOST_DARTS - 1) * k.MOST_DARTS, 2)
        self._facts, self._ends = _ints(4), _ints(4)
        self._tree = _ints(k.VERTICES)
        self._depth = _ints(k.VERTICES)
        self._size, self._rule, self._overlap = 0, k.NONE, False
        # callees first, or numba would compile them for the types of their callers
        self._tie, self._same_walk = compiled(k.tie, k.STATES), compiled(k.same_walk, k.STATES)
        self._try = compiled(k.tried, k.STATES)
        self._outward, self._behind = compiled(k.outward, k.STATES), compiled(k.behind, k.STATES)
        self._search_world = compiled(k.search_world, k.STATES)

    def search(self, size: int, rule: int, *, overlap: bool) -> None:
        """Search the states of the world in the table, which has `size` darts."""
        self._size, self._rule, self._overlap = size, rule, overlap
        self._search_world(
            self.world, size, rule, overlap, self._work, self._cost, self._low, self._darts,
            self._row, self._kills, self._best, self.found, self._facts, self._ends,
            self._tree, self._depth,
        )  # fmt: skip

    def order(self, end: int) -> RunOrder:
        """A run of that world with the least cost (`end` 0), or the most (1)."""
        return tuple(self._edges(end))

    def _edges(self, end: int) -> Iterator[tuple[Dart, ...]]:
        here, at = 0, 0
        for _ in range(self._size // 2):
            key = int(self._work[k.KEY, here])
            explored, entries = key & (1 << k.MOST_DARTS) - 1, key >> k.MOST_DARTS
            e = self._pick(explored, entries, here, at, end)
            self._outward(self.world, explored, entries, 0, self._tree, self._depth)
            self._behind(
                self.world, explored, entries, self._tree, e, self._rule, self._overlap,
                self._darts, self._row, self._kills, self._facts, self._best, self._ends,
            )  # fmt: skip
            yield e, *self._tried(end)
            here, at = divmod(int(self._low[here, e, 2]), k.VERTICES)

    def _pick(self, explored: int, entries: int, here: int, at: int, end: int) -> Dart:
        """The first e with which the cost can be reached."""
        self._outward(self.world, explored, entries, at, self._tree, self._depth)
        for e in range(self._size):
            vertex = int(self.world[1, e])
            if not explored >> e & 1 and entries >> 4 * vertex & 15 != k.UNKNOWN:
                number, there = divmod(int(self._low[here, e, 2]), k.VERTICES)
                to_pay = self._low[here, e, end] + self._cost[number, there, end]
                if self._depth[vertex] + 1 + to_pay == self._cost[here, at, end]:
                    return e
        raise AssertionError("some way has the least cost")

    def _tried(self, end: int) -> Iterator[Dart]:
        count, true = int(self._facts[0]), int(self._facts[1])
        remaining, last = (1 << count) - 1, count
        free = bool(self._facts[2]) or (self._rule == k.NONE and not self._overlap)
        while remaining:
            mask = self._tie(self._row, remaining, last, count, self._overlap and not free)
            allowed = [place for place in range(count) if mask >> place & 1]
            if free:  # the true one first, or last
                place = min(allowed, key=lambda option: (option == true) == bool(end))
            else:
                index = remaining * (count + 1) + last
                place = next(
                    option
                    for option in allowed
                    if self._paid(remaining, last, option)[end] == self._best[index, end]
                )
            yield int(self._darts[place])
            if self._row[place, 2] < 0:
                return
            remaining &= ~int(self._kills[place])
            walked = self._overlap and self._row[place, 1]
            last = self._same_walk(self._row, place) if walked else count

    def _paid(self, remaining: int, last: int, place: int) -> tuple[int, int]:
        count = int(self._facts[0])
        paid: tuple[int, int] = self._try(
            self._row, self._kills, count, self._overlap, self._best, remaining, last, place
        )
        return paid


def _ints(*shape: int, fill: int = 0) -> Any:
    return np.full(shape, fill, np.int64)
