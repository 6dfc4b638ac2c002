"""Seconds that a mapper has used, however busy the machine is.

The stopwatch is a wall clock that stops while the mapper waits in the kernel's queue for a
processor (second field of /proc/…/schedstat; the first is its running time). Rejected: processor
time alone, since a mapper could sleep for ever; wall time alone, which convicts a correct mapper on
a busy machine.

A thread that waits for an answer wakes up now and then to look for it, and queues each time. Only
the last of these waits delays the answer; the earlier ones count as used. If a look at the
stopwatch, due once a tick, is missing, the machine was frozen: one tick and the processor time
count.

What this does not show: time that a hypervisor takes, and waits for a disk or for memory, count as
used. Without /proc the stopwatch is the wall clock.

A *task* is a thread, named by its folder below /proc.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from math import inf
from time import monotonic
from typing import NamedTuple

Tasks = Callable[[], Iterable[str]]
"""Lists the tasks at work: programs start threads and children."""

Heard = Callable[[], int]
"""The number of answers so far."""


class Stopwatch:
    """Measures the seconds used since it was made, by the thread that made it.

    Args:
        helper: lists the tasks that work for that thread while it waits.
        heard: counts their answers; without it each wait is excused.
        tick: the most seconds between two looks.
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
        # they take turns, so waits add up
        in_vain = 0.0
        if (helper := self._helper) is not None:
            helper_ran, helper_waited = helper.since(now - self._looked)
            in_vain = helper.in_vain(waited)
            ran, waited = max(ran, helper_ran), waited + helper_waited
        passed = now - self._looked
        if passed - waited > 2 * self._tick:
            passed = min(passed, waited + self._tick + ran)
        waited -= in_vain
        # The kernel books a wait when it ends: a difference may be negative, the sum is right
        # unless both waited at the same time. What ran was used, however long they waited.
        self._ran += min(ran, passed)
        self._used = max(self._used + passed - waited, self._ran)
        self._looked, self._account = now, account
        return self._used

    @contextmanager
    def helped_by(self, tasks: Tasks, heard: Heard | None = None) -> Generator[None]:
        """Within the block, count the waits of these tasks as the thread's own."""
        self._helper = _Helper(tasks, heard)
        try:
            yield
        finally:
            self._helper = None


class _Account(NamedTuple):
    """The kernel's account of a task: seconds on a processor, and ready without one."""

    ran: float
    waited: float

    def since(self, before: _Account) -> _Account:
        """The difference to an earlier account."""
        return _Account(self.ran - before.ran, self.waited - before.waited)


NOTHING = _Account(0.0, 0.0)


class _Helper:
    """The account of each task at the last look, and the thread's waits by then."""

    def __init__(self, tasks: Tasks, heard: Heard | None = None) -> None:
        self._tasks = tasks
        self._accounts = {task: _account(task) for task in tasks()}
        self._heard = heard
        self._answers = heard() if heard else 0
        self._excused = 0.0  # the last unanswered wait

    def in_vain(self, waited: float) -> float:
        """Seconds excused at the last look, though no answer came; `waited` is excused now."""
        if self._heard is None:
            return 0.0
        before, self._answers = self._answers, self._heard()
        answered = self._answers != before
        in_vain = 0.0 if answered else self._excused
        self._excused = 0.0 if answered else waited
        return in_vain

    def since(self, passed: float) -> _Account:
        """The longest run and the longest wait since the last look: tasks work side by side."""
        before = self._accounts
        self._accounts = {
            task: _with_open_wait(task, _account(task), before.get(task), passed)
            for task in self._tasks()
        }
        # a new task's running time before the last look is unknown
        booked = [
            now.since(before.get(task, _Account(now.ran, 0.0)))
            for task, now in self._accounts.items()
        ]
        return _Account(*map(max, zip(*booked, strict=True))) if booked else NOTHING


def tasks_of(process: int) -> Iterator[str]:
    """The threads of a process and of all its descendants."""
    todo = [str(process)]
    for parent in todo:  # grows
        for folder in _entries(f"/proc/{parent}/task"):
            task = f"{parent}/task/{folder}"
            yield task
            todo += _read(f"/proc/{task}/children").split()


def _account(task: str) -> _Account:
    fields = _read(f"/proc/{task}/schedstat").split()
    return _Account(int(fields[0]) / 1e9, int(fields[1]) / 1e9) if fields else NOTHING


def _with_open_wait(task: str, now: _Account, before: _Account | None, passed: float) -> _Account:
    """The account with a wait that goes on: the kernel books a wait when it ends.

    A limit would have been passed by then. Once it is booked, the difference is small or negative.
    """
    if before is None or now.ran != before.ran or not _is_ready(task):
        return now
    return _Account(now.ran, before.waited + passed)


def _is_ready(task: str) -> bool:
    """Whether the task runs or waits for a processor."""
    return _read(f"/proc/{task}/stat").rpartition(")")[2].startswith(" R")


def _entries(folder: str) -> list[str]:
    try:
        return os.listdir(folder)  # noqa: PTH208  a Path an entry takes three times as long
    except OSError:
        return []


def _read(path: str) -> str:
    """The text of a small file, or ""."""
    try:
        file = os.open(path, os.O_RDONLY)  # `open` takes longer, and every run reads this
    except OSError:
        return ""
    try:
        return os.read(file, 1 << 16).decode()
    except OSError:
        return ""
    finally:
        os.close(file)
