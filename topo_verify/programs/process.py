"""What a child process does beside the pipe: its processor, its exit status, its standard error.

**Processor.** A program is kept on the processor of the thread that talks to it.
The two take turns: one waits while the other works. On one processor the kernel switches between
them in a few microseconds. On two, each message wakes up a processor that idles, which takes tens
of them, more on a virtual machine: that decides how many moves a second go through the pipe.

The thread is kept there, too, as long as a world lasts: were it moved to another processor, each
message would wake one up again (9,400 moves a second in the place of 43,000, on two cores).

A program with several threads or children is released as soon as they are seen.
So is one that has chosen its processors itself. Systems without `sched_setaffinity` do nothing.

**Exit status.** It is looked up without reaping the process. A process that is not reaped keeps its
number, so that no other process can be taken for it before `Child.end` has ended the rest of its
group.

**Standard error.** Its end is kept for the report, or all of it appears on ours, line by line.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from contextlib import suppress
from typing import Any, NamedTuple

from topo_verify.errors import shown
from topo_verify.robot.stopwatch import tasks_of

LOOK_AGAIN = 16
"""Number of worlds between two looks at whether the program has more than one thread."""


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


# ---------------------------------------------------------------- how it ended


class ExitStatus(NamedTuple):
    """How a process ended: a code of `waitid` (CLD_EXITED, …), and the exit code or the signal."""

    code: int
    number: int

    def __str__(self) -> str:
        """The exit status in words, as in "the program ended with exit code 1"."""
        if self.code == os.CLD_EXITED:
            return f"ended with exit code {self.number}"
        return f"was ended by {self.signal}"

    @property
    def signal(self) -> str | None:
        """The name of the signal that ended the process, as SIGSEGV; None: none did."""
        if self.code == os.CLD_EXITED:
            return None
        with suppress(ValueError):
            return signal.Signals(self.number).name
        return f"signal {self.number}"


def exit_status(process: int) -> ExitStatus | None:
    """The exit status of a child process; None while it runs."""
    found = os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT | os.WNOHANG)
    return None if found is None else ExitStatus(found.si_code, found.si_status)


# ---------------------------------------------------------------- its standard error


TAIL = 4096
"""How many bytes of standard error are kept: the last ones."""


class StandardError:
    """The standard error of a program: its end, and how much there was. Grows as it is read.

    Args:
        mark: what stands before each line on our own standard error; None: it does not appear.
    """

    def __init__(self, mark: str | None) -> None:
        self.bytes = 0
        self._mark, self._tail, self._rest = mark, bytearray(), b""

    @property
    def tail(self) -> str:
        """The last `TAIL` bytes."""
        return self._tail.decode(errors="backslashreplace")

    def take(self, chunk: bytes) -> None:
        """Note what was read; nothing means the end."""
        self.bytes += len(chunk)
        self._tail += chunk
        del self._tail[:-TAIL]
        if self._mark is None:
            return
        *lines, self._rest = (self._rest + chunk).split(b"\n")
        if self._rest and (not chunk or len(self._rest) > TAIL):
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            with suppress(OSError, ValueError):  # ours is closed, or full
                text = shown(line.decode(errors="backslashreplace"), limit=TAIL)
                sys.stderr.write(f"{self._mark}: {text}\n")
                sys.stderr.flush()
