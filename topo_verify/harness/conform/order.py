"""The order in which an implementation meets the worlds: drawn, so that it cannot count them.

A corpus has a fixed order. A program that knew it could tell by counting which world it is in, and
be right without exploring. So each `BLOCK` of worlds is examined in an order that is drawn by a
seed; the results are handed on in the order of the corpus, so they do not depend on the seed.

What this does not show: that a program does not know in which block it is. The first one holds all
worlds of up to five edges; with one block more or less it is as good as the whole corpus.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from itertools import islice
from random import Random
from typing import NamedTuple

from topo_verify.harness.conform.outcome import WorldResult
from topo_verify.harness.corpus import Named

BLOCK = 10_000
"""So many worlds are drawn from at a time."""


class Placed(NamedTuple):
    """A world and its place in the corpus."""

    place: int
    at: Named


Examine = Callable[[Iterator[Placed], Callable[[], bool]], Iterable[tuple[int, WorldResult]]]
"""Examines worlds: takes them, and whether there is room for more results; gives each result with
the place of its world, as they are finished."""


class DrawnOrder:
    """Examines the worlds of a corpus in a drawn order. Life cycle: iterate `results` once.

    Args:
        seed: of the order.
        examine: how worlds are examined.
        enough: after so many time-outs the worlds come in the order of the corpus. Where the work
            ends then depends on the corpus alone, not on the seed.
    """

    def __init__(self, worlds: Iterable[Named], seed: int, examine: Examine, enough: int) -> None:
        self._worlds, self._random = worlds, Random(seed)
        self._examine, self._enough = examine, enough
        self._waiting: dict[int, WorldResult] = {}  # by place: one before it is not finished
        self._timeouts = 0

    def results(self) -> Generator[WorldResult]:
        """The results in the order of the corpus; after Ctrl-C, those that there are."""
        due = 0
        try:
            for place, made in self._examine(self._drawn(), self._has_room):
                self._waiting[place] = made
                self._timeouts += made.timeout
                while due in self._waiting:
                    yield self._waiting.pop(due)
                    due += 1
        except KeyboardInterrupt:
            yield from (made for _, made in sorted(self._waiting.items()))
            raise

    def _has_room(self) -> bool:
        return len(self._waiting) < 2 * BLOCK

    def _drawn(self) -> Iterator[Placed]:
        begin, worlds = 0, iter(self._worlds)
        while block := list(islice(worlds, BLOCK)):
            drawn = list(range(len(block)))
            self._random.shuffle(drawn)
            left = dict.fromkeys(range(len(block)))
            while left:
                place = drawn.pop() if self._timeouts < self._enough else next(iter(left))
                if place in left:
                    del left[place]
                    yield Placed(begin + place, block[place])
            begin += len(block)
