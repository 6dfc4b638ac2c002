"""Progress of long work: the callback that is told of it, and the rate at which the work goes."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from time import monotonic

Progress = Callable[[str, int, int], None]
"""A progress callback, called as work goes on: (what, how much is done, how much there is)."""


def no_progress(_what: str, _done: int, _total: int) -> None:
    """A progress callback that does nothing."""


INTERVAL = 0.1
"""Seconds between two calls of a progress callback, at least."""


class ProgressRate:
    """Counts finished worlds and reports them, with worlds per second and the time left.

    Lives as long as a search.

    Args:
        what: the name of the work, as reported.
        total: how many worlds there are.
        report: the progress callback; None: nothing is reported.

    Attributes:
        done: how many worlds were finished, without those that a ledger knew.
    """

    def __init__(self, what: str, total: int, report: Progress | None) -> None:
        self._what, self._total, self._report = what, total, report
        self._begin = monotonic()
        self._reported = -inf  # never
        self._known = 0  # worlds that a ledger knew: they took no time, so the rate leaves them out
        self.done = 0

    def known(self, worlds: int) -> None:
        """Count worlds that were finished before this search began."""
        self._known += worlds
        self.in_flight(0)

    def finished(self, worlds: int) -> None:
        """Count worlds that were finished now."""
        self.done += worlds
        self.in_flight(0)

    def in_flight(self, worlds: int) -> None:
        """Report, unless it is too soon; `worlds` are finished in shards that are not."""
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
