"""A child process beside the pipe: its processor, its exit status, its standard error.

**Processor.** Program and harness thread take turns. On one processor the kernel switches between
them in a few microseconds; on two, each message wakes an idle processor, which takes tens of them.
So a program with a single thread is kept on the harness thread's processor during a world. Programs
with several threads or children, or with processors of their choice, are released.

**Exit status.** It is read without reaping, so the process keeps its number until `Child.end` has
ended its group.
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
"""Worlds between two counts of the program's threads."""


class SharedProcessor:
    """Keeps a program and the thread that talks to it on one processor.

    Attributes:
        shared: the program is kept on our processor.
    """

    def __init__(self, process: int) -> None:
        self._process, self._worlds = process, 0
        self._bound: int | None = None
        self._ours: set[int] = set()
        self.shared = False

    def follow(self) -> None:
        """Before a world: move a program with a single thread to our processor; release others."""
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
        """After a world: undo `follow` for this thread."""
        if self._ours:
            os.sched_setaffinity(0, self._ours)
            self._ours = set()

    def _move_to(self, here: int) -> None:
        with suppress(OSError):
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
    number: int = _getcpu() if _getcpu is not None and hasattr(os, "sched_setaffinity") else -1
    return None if number < 0 else number


_getcpu: Any = getattr(ctypes.CDLL(None), "sched_getcpu", None)


# ---------------------------------------------------------------- how it ended


class ExitStatus(NamedTuple):
    """How a process ended: a code of `waitid` (CLD_EXITED, …), and the exit code or the signal."""

    code: int
    number: int

    def __str__(self) -> str:
        if self.code == os.CLD_EXITED:
            return f"ended with exit code {self.number}"
        return f"was ended by {self.signal}"

    @property
    def signal(self) -> str | None:
        """The signal that ended the process, as SIGSEGV, or None."""
        if self.code == os.CLD_EXITED:
            return None
        with suppress(ValueError):
            return signal.Signals(self.number).name
        return f"signal {self.number}"


SUCCESS = ExitStatus(os.CLD_EXITED, 0)


def exit_status(process: int) -> ExitStatus | None:
    """The exit status of a child process; None while it runs."""
    end = os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT | os.WNOHANG)
    return None if end is None else ExitStatus(end.si_code, end.si_status)


# ---------------------------------------------------------------- its standard error


TAIL = 4096
"""Last bytes of standard error that are kept."""

FATAL = b"Fatal Python error: "
"""Begins the stack that faulthandler writes when a signal ends a mapper."""

_fatal_shown: set[str] = set()
"""The marks of mappers whose fatal error was copied by this process; later ones are not."""


class StandardError:
    """The standard error of a program: its end, and its length.

    Args:
        mark: copy it to ours, each line behind this mark; None: do not. Of a mapper's fatal
            errors, a process copies the first alone: every world may have one.
    """

    def __init__(self, mark: str | None) -> None:
        self.bytes = 0
        self._mark, self._tail, self._rest = mark, bytearray(), b""

    @property
    def tail(self) -> str:
        """The last `TAIL` bytes."""
        return self._tail.decode(errors="backslashreplace")

    def take(self, chunk: bytes) -> None:
        """Add a chunk; an empty one means the end."""
        self.bytes += len(chunk)
        self._tail += chunk
        del self._tail[:-TAIL]
        if self._mark is None:
            return
        *lines, self._rest = (self._rest + chunk).split(b"\n")
        if self._rest and (not chunk or len(self._rest) > TAIL):
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            if line.startswith(FATAL):
                if self._mark in _fatal_shown:
                    self._mark = None
                    return
                _fatal_shown.add(self._mark)
            with suppress(OSError, ValueError):
                text = shown(line.decode(errors="backslashreplace"), limit=TAIL)
                sys.stderr.write(f"{self._mark}: {text}\n")
                sys.stderr.flush()
