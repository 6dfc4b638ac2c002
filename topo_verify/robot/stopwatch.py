"""Seconds that a mapper has used, whoever else keeps the machine busy.

The stopwatch goes like the wall clock and stands still while the mapper waits in the kernel's queue
for a processor (second field of /proc/…/schedstat). So a mapper that sleeps uses up seconds, one
that computes uses up its processor time, and one that others keep from computing uses up none.
Neither clock alone would do: processor time lets a mapper sleep for ever, and the wall clock
convicts a correct mapper on a busy machine.

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
from pathlib import Path
from time import monotonic

Tasks = Callable[[], Iterable[str]]
"""Lists the tasks at work; asked at each look, because a program starts threads and children."""


class Stopwatch:
    """Measures the seconds used since it was made, by the thread that made it.

    Args:
        helper: lists the tasks that work for that thread while it waits for them.
    """

    def __init__(self, helper: Tasks | None = None) -> None:
        self._own = f"self/task/{threading.get_native_id()}"
        self._used, self._looked, self._queued = 0.0, monotonic(), _queued(self._own)
        self._helper = _Helper(helper) if helper else None

    def seconds(self) -> float:
        """The seconds used so far."""
        now, queued = monotonic(), _queued(self._own)
        waited = queued - self._queued
        # The thread and its helper take turns (one writes, the other reads): their waits add up.
        if (helper := self._helper) is not None:
            waited += helper.waited()
        # The kernel books a wait when it ends: the difference may be negative, the sum is right.
        self._used += now - self._looked - waited
        self._looked, self._queued = now, queued
        return self._used

    @contextmanager
    def helped_by(self, tasks: Tasks) -> Generator[None]:
        """Make the wait of these tasks count as the thread's own, as long as the block runs."""
        self._helper = _Helper(tasks)
        try:
            yield
        finally:
            self._helper = None


class _Helper:
    """Remembers how long each task had waited at the last look."""

    def __init__(self, tasks: Tasks) -> None:
        self._tasks = tasks
        self._queued = {task: _queued(task) for task in tasks()}

    def waited(self) -> float:
        """The longest wait of a task since the last look: tasks wait side by side."""
        before = self._queued
        self._queued = {task: _queued(task) for task in self._tasks()}
        waits = (queued - before.get(task, 0.0) for task, queued in self._queued.items())
        return max(waits, default=0.0)


def tasks_of(process: int) -> Iterator[str]:
    """The threads of a process and of all processes that descend from it."""
    todo = [str(process)]
    for parent in todo:  # grows while it is read
        for folder in _entries(f"/proc/{parent}/task"):
            task = f"{parent}/task/{folder}"
            yield task
            todo += _read(f"/proc/{task}/children").split()


def _queued(task: str) -> float:
    """Seconds that a task was ready to run while others ran; 0 if it has ended, or nobody knows."""
    fields = _read(f"/proc/{task}/schedstat").split()
    return int(fields[1]) / 1e9 if fields else 0.0


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
