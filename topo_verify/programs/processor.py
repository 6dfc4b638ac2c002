"""Keeps a program on the processor of the thread that talks to it.

The two take turns: one waits while the other works. On one processor the kernel switches between
them in a few microseconds. On two, each message wakes up a processor that idles, which takes tens
of them, more on a virtual machine: that decides how many moves a second go through the pipe.

The thread is kept there, too, as long as a world lasts: were it moved to another processor, each
message would wake one up again (9,400 moves a second in the place of 43,000, on two cores).

A program with several threads or children of its own is let go, as soon as it is seen to have them.
So is one that has chosen its processors itself. Systems without `sched_setaffinity` do nothing.
"""

from __future__ import annotations

import ctypes
import os
from contextlib import suppress
from typing import Any

from topo_verify.robot.stopwatch import tasks_of

LOOK_AGAIN = 16
"""After so many worlds see whether the program has become more than one thread."""


class SharedProcessor:
    """Where a program runs, and the thread that talks to it.

    Life cycle: `follow` before each world, `release` after it, both in that thread.

    Args:
        process: the program's process.
    Attributes:
        shared: the program is kept on one processor with us.
    """

    def __init__(self, process: int) -> None:
        self._process, self._worlds = process, 0
        self._bound: int | None = None  # the processor to which we have bound it
        self._ours: set[int] = set()  # where this thread may run, while it is kept on one
        self.shared = False

    def follow(self) -> None:
        """Move a program with a single thread to the processor of this thread; let others go."""
        here = _processor()
        self._worlds += 1
        if here is None:
            return
        if here != self._bound or not self._worlds % LOOK_AGAIN:
            self._move_to(here)
        if self.shared:
            self._ours = os.sched_getaffinity(0)
            os.sched_setaffinity(0, {here})

    def release(self) -> None:
        """Let this thread run again where it might before `follow`."""
        if self._ours:
            os.sched_setaffinity(0, self._ours)
            self._ours = set()

    def _move_to(self, here: int) -> None:
        with suppress(OSError):  # it has ended
            ours, tasks = os.sched_getaffinity(0), list(tasks_of(self._process))
            if len(tasks) == 1:
                if self._bound is not None or os.sched_getaffinity(self._process) == ours:
                    os.sched_setaffinity(self._process, {here})
                    self._bound, self.shared = here, True
            elif self._bound is not None:
                self._bound, self.shared = None, False
                for task in tasks:
                    os.sched_setaffinity(int(task.rpartition("/")[2]), ours)


def _processor() -> int | None:
    """The number of the processor that runs this thread; None if the system does not tell."""
    number: int = _getcpu() if _getcpu is not None and hasattr(os, "sched_setaffinity") else -1
    return None if number < 0 else number


_getcpu: Any = getattr(ctypes.CDLL(None), "sched_getcpu", None)
