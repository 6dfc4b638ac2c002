"""How fast a search goes: what is done, worlds a second, and how long it will take."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from time import monotonic

Tell = Callable[[str, int, int], None]
"""Called as work goes on: (what, how many worlds are done, how many there are)."""

OFTEN = 0.1
"""Least seconds between two calls."""


class Pace:
    """Told how far the work is, tells it on, not too often. Lives as long as a search.

    Args:
        what: the mapper.
        total: how many worlds there are.

    Attributes:
        done: how many worlds are done, without those that a ledger knew.
    """

    def __init__(self, what: str, total: int, tell: Tell | None) -> None:
        self._what, self._total, self._tell = what, total, tell
        self._begin = monotonic()
        self._told = -inf  # never
        self._known = 0  # worlds that a ledger knew: they took no time
        self.done = 0

    def known(self, worlds: int) -> None:
        """So many more were done before this search began."""
        self._known += worlds
        self.flying(0)

    def landed(self, worlds: int) -> None:
        """So many more are done."""
        self.done += worlds
        self.flying(0)

    def flying(self, worlds: int) -> None:
        """So many are done in shards that are not."""
        now = monotonic()
        if self._tell is None or now < self._told + OFTEN:
            return
        self._told = now
        fresh = self.done + worlds
        done = min(self._known + fresh, self._total)
        text = self._what
        if fresh and now > self._begin:
            rate = fresh / (now - self._begin)
            text += f", {rate:,.0f} worlds/s, {duration((self._total - done) / rate)} left"
        self._tell(text, done, self._total)


def duration(seconds: float) -> str:
    """`40 s`, `12 min`, `7 h`, `30 days`: enough to decide whether to wait."""
    for unit, size in (("s", 1), ("min", 60), ("h", 3600)):
        if seconds < 100 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 86400:.0f} days"
