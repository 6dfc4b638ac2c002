"""Progress: worlds that are finished, worlds per second, and the time left."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from time import monotonic

from topo_verify.errors import InputError, plural

Progress = Callable[[str, int, int], None]
"""A progress callback: (what is done, how fast and how long; amount done; total)."""


def no_progress(_work: str, _done: int, _total: int) -> None:
    """Do nothing: a progress callback."""


INTERVAL = 0.1
"""Least seconds between two calls of a progress callback."""


SLOW = 2.0
"""Seconds without a finished world after which the one that runs is named."""


class ProgressRate:
    """Reports finished worlds, worlds per second and the time left.

    Attributes:
        done: worlds finished now, without those of a store.
    """

    def __init__(self, work: str, total: int, report: Progress | None) -> None:
        if report is not None and not callable(report):
            raise InputError(
                "tell: expected a function of words, the amount done and the total, such as print,"
                f" got {report!r}"
            )
        self._work, self._total, self._report = work, total, report
        self._begin = monotonic()
        self._reported = -inf
        self._advanced = self._begin
        self._at_work = "", 0
        self._known = 0  # worlds that a ledger knew: they took no time, so the rate leaves them out
        self._most = 0  # an open shard that ends early, or is begun again, takes back no progress
        self.done = 0

    def known(self, worlds: int) -> None:
        """Count worlds that were finished before."""
        self._known += worlds
        self.in_flight(0)

    def finished(self, worlds: int) -> None:
        """Count worlds that were finished now."""
        self.done += worlds
        self.in_flight(0)

    def in_flight(self, worlds: int, name: str = "", moves: int = 0, /) -> None:
        """Report the end, and else if it is not too soon.

        Args:
            worlds: those finished in open shards.
            name, moves: of a world that runs. It is named if it holds up all others.
        """
        now = monotonic()
        done = max(self._most, min(self._known + self.done + worlds, self._total))
        if done > self._most:
            self._most, self._advanced, self._at_work = done, now, ("", 0)
        if name:  # kept while the run is judged
            self._at_work = name, moves
        name, moves = self._at_work
        fresh = done - self._known
        soon = done < self._total and now < self._reported + INTERVAL
        is_slow = bool(name) and now > self._advanced + SLOW
        if self._report is None or soon:
            return
        self._reported = now
        text = self._work
        if fresh and now > self._begin:
            rate = fresh / (now - self._begin)
            text += f", {rate:,.0f} worlds/s"
            if not is_slow:
                text += f", {duration((self._total - done) / rate)} left"
        if is_slow:
            text += f", {name}: {plural(moves, 'move')}"
        self._report(text, done, self._total)


def duration(seconds: float) -> str:
    """A duration in one unit, exact enough to decide whether to wait: `40 s`, `12 min`."""
    for unit, size in (("s", 1), ("min", 60), ("h", 3600)):
        if seconds < 100 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 86400:.0f} days"
