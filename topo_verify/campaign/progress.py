"""The progress callback of long work, and the rate of the work."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from time import monotonic

Progress = Callable[[str, int, int], None]
"""A progress callback, called as work goes on: (what, how much is done, how much there is)."""


def no_progress(_what: str, _done: int, _total: int) -> None:
    """A progress callback that does nothing."""


INTERVAL = 0.1
"""Least seconds between two calls of a progress callback."""


class ProgressRate:
    """Counts finished worlds and reports them, with worlds per second and the time left.

    Args:
        what: the name of the work, as reported.
        total: number of worlds.
        report: the progress callback, or None.

    Attributes:
        done: number of worlds finished now, without those of a store.
    """

    def __init__(self, what: str, total: int, report: Progress | None) -> None:
        self._what, self._total, self._report = what, total, report
        self._begin = monotonic()
        self._reported = -inf
        self._known = 0  # worlds that a ledger knew: they took no time, so the rate leaves them out
        self.done = 0

    def known(self, worlds: int) -> None:
        """Count worlds that were finished before."""
        self._known += worlds
        self.in_flight(0)

    def finished(self, worlds: int) -> None:
        """Count worlds that were finished now."""
        self.done += worlds
        self.in_flight(0)

    def in_flight(self, worlds: int) -> None:
        """Report, unless it is too soon; `worlds` are finished in unfinished shards."""
        now = monotonic()
        if self._report is None or now < self._reported + INTERVAL:
            return
        self._reported = now
        fresh = self.done + worlds
        done = min(self._known + fresh, self._total)
        text = self._what
        if fresh and now > self._begin:
            rate = fresh / (now - self._begin)
            text += f", {rate:,.0f} worlds/s, {duration((self._total - done) / rate)} left"
        self._report(text, done, self._total)


def duration(seconds: float) -> str:
    """A duration in one unit, exact enough to decide whether to wait: `40 s`, `12 min`, `7 h`."""
    for unit, size in (("s", 1), ("min", 60), ("h", 3600)):
        if seconds < 100 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 86400:.0f} days"
