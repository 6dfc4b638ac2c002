"""Seconds that a mapper has used, whoever else keeps the machine busy.

The stopwatch goes like the wall clock and stands still while the mapper waits in the kernel's queue
for a processor (second field of /proc/…/schedstat; the first is what it ran). So a mapper that
sleeps uses up seconds, one that computes uses up its processor time, and one that others keep from
computing uses up none.
Neither clock alone would do: processor time lets a mapper sleep for ever, and the wall clock
convicts a correct mapper on a busy machine.

A thread that waits for an answer wakes up now and then to look for it, and waits for a processor
each time. Only the last of these waits keeps the answer from it: the others are used, for in them
it was the turn of the mapper, which may have slept.

A machine may be frozen: it is suspended, a container is paused, all processes get SIGSTOP. Those
who look at a stopwatch look at it again and again, a tick apart. If a look is missing, they did not
run, and nor did the mapper: of that time one tick is used, and whatever a processor was at work.

What this does not show: what a hypervisor takes away from the whole machine, and waiting for a disk
or for memory; they count as used. Where the kernel keeps no such account (on systems other than
Linux), the stopwatch is the wall clock.

Vocabulary: a *task* is a thread, named by its folder below /proc.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from math import inf
from pathlib import Path
from time import monotonic
from typing import NamedTuple

Tasks = Callable[[], Iterable[str]]
"""Lists the tasks at work; asked at each look, because a program starts threads and children."""

Heard = Callable[[], int]
"""Counts what the tasks at work have answered so far."""


class Stopwatch:
    """Measures the seconds used since it was made, by the thread that made it.

    Args:
        helper: lists the tasks that work for that thread while it waits for them.
        heard: counts their answers; without it each wait of the thread is excused.
        tick: seconds between two looks, at most, while those who look at it run.
    """

    def __init__(
        self, helper: Tasks | None = None, heard: Heard | None = None, *, tick: float = inf
    ) -> None:
        self._tick = tick
        self._own = f"self/task/{threading.get_native_id()}"
        self._used, self._ran = 0.0, 0.0
        self._looked, self._account = monotonic(), _account(self._own)
        self._helper = _Helper(helper, heard) if helper else None

    def seconds(self) -> float:
        """The seconds used so far."""
        now, account = monotonic(), _account(self._own)
        ran, waited = account.since(self._account)
        # The thread and its helper take turns (one writes, the other reads): their waits add up.
        in_vain = 0.0
        if (helper := self._helper) is not None:
            helper_ran, helper_waited = helper.since()
            in_vain = helper.in_vain(waited)
            ran, waited = max(ran, helper_ran), waited + helper_waited
        passed = now - self._looked
        if passed - waited > 2 * self._tick:  # a look is missing
            passed = min(passed, waited + self._tick + ran)
        waited -= in_vain
        # The kernel books a wait when it ends: the difference may be negative, the sum is right,
        # unless both waited at the same time. What ran was used, however long the two waited.
        self._ran += min(ran, passed)
        self._used = max(self._used + passed - waited, self._ran)
        self._looked, self._account = now, account
        return self._used

    @contextmanager
    def helped_by(self, tasks: Tasks, heard: Heard | None = None) -> Generator[None]:
        """Make the wait of these tasks count as the thread's own, as long as the block runs.

        Args:
            heard: counts their answers; without it each wait of the thread is excused.
        """
        self._helper = _Helper(tasks, heard)
        try:
            yield
        finally:
            self._helper = None


class _Account(NamedTuple):
    """What the kernel has booked for a task: seconds on a processor, and ready without one."""

    ran: float
    waited: float

    def since(self, before: _Account) -> _Account:
        """What was booked since then."""
        return _Account(self.ran - before.ran, self.waited - before.waited)


NOTHING = _Account(0.0, 0.0)


class _Helper:
    """Remembers the account of each task at the last look, and what the thread waited by then."""

    def __init__(self, tasks: Tasks, heard: Heard | None = None) -> None:
        self._tasks = tasks
        self._accounts = {task: _account(task) for task in tasks()}
        self._heard = heard
        self._answers = heard() if heard else 0
        self._excused = 0.0  # of the thread's waits since the last answer: the last one

    def in_vain(self, waited: float) -> float:
        """Seconds that were excused at the last look, though no answer has come since.

        Args:
            waited: the seconds that the thread has waited since the last look; they are excused.
        """
        if self._heard is None:
            return 0.0
        before, self._answers = self._answers, self._heard()
        answered = self._answers != before
        in_vain = 0.0 if answered else self._excused
        self._excused = 0.0 if answered else waited
        return in_vain

    def since(self) -> _Account:
        """The longest run and the longest wait since the last look: tasks work side by side."""
        before = self._accounts
        self._accounts = {task: _account(task) for task in self._tasks()}
        # Of a task that is new only the wait counts: when it ran is not known.
        booked = [
            now.since(before.get(task, _Account(now.ran, 0.0)))
            for task, now in self._accounts.items()
        ]
        return _Account(*map(max, zip(*booked, strict=True))) if booked else NOTHING


def tasks_of(process: int) -> Iterator[str]:
    """The threads of a process and of all processes that descend from it."""
    todo = [str(process)]
    for parent in todo:  # grows while it is read
        for folder in _entries(f"/proc/{parent}/task"):
            task = f"{parent}/task/{folder}"
            yield task
            todo += _read(f"/proc/{task}/children").split()


def _account(task: str) -> _Account:
    """The account of a task; nothing if it has ended, or nobody keeps one."""
    fields = _read(f"/proc/{task}/schedstat").split()
    return _Account(int(fields[0]) / 1e9, int(fields[1]) / 1e9) if fields else NOTHING


def _entries(folder: str) -> list[str]:
    try:
        return [path.name for path in Path(folder).iterdir()]
    except OSError:
        return []


def _read(path: str) -> str:
    """The text of a small file of /proc; empty if there is none (any more)."""
    try:
        file = os.open(path, os.O_RDONLY)  # read at the start of every run: `open` takes longer
    except OSError:
        return ""
    try:
        return os.read(file, 1 << 16).decode()
    except OSError:  # the process ended after the file was opened
        return ""
    finally:
        os.close(file)
