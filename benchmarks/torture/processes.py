"""Processes that still live after a command ended.

The torture adopts orphans (`PR_SET_CHILD_SUBREAPER`): what a command leaves behind becomes a child
of this process, in any session or group.
"""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep

PATIENCE = 5.0
"""Seconds that helpers have to end after their command."""

_SUBREAPER = 36


def adopt() -> None:
    """Let orphans become children of this process."""
    if ctypes.CDLL(None, use_errno=True).prctl(_SUBREAPER, 1, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "prctl(PR_SET_CHILD_SUBREAPER) is refused")


def children(of: int | None = None) -> list[int]:
    """The living children of a process, by default of this one; zombies are reaped."""
    found: list[int] = []
    with suppress(OSError):
        for task in Path(f"/proc/{of or os.getpid()}/task").iterdir():
            found += map(int, (task / "children").read_text(encoding="ascii").split())
    return [process for process in found if not _is_dead(process)]


def _is_dead(process: int) -> bool:
    with suppress(OSError):
        state = Path(f"/proc/{process}/stat").read_text(encoding="utf-8", errors="replace")
        return state.rpartition(")")[2].split()[0] in "ZX"
    return True


def descendants(of: int) -> list[int]:
    """The living descendants of a process, parents first."""
    found = children(of)
    for process in found:  # grows as it goes
        found += children(process)
    return found


def left_over(before: Collection[int]) -> int:
    """The number of processes that outlive `PATIENCE`; they are ended and reaped.

    Args:
        before: the children of this process before the command began.
    """
    until = monotonic() + PATIENCE
    while (left := [one for one in children() if one not in before]) and monotonic() < until:
        _reap(before)
        sleep(0.01)
    for process in left:
        for one in (*descendants(process), process):
            with suppress(OSError):
                os.kill(one, signal.SIGKILL)
    _reap(before)
    return len(left)


def _reap(before: Collection[int]) -> None:
    with suppress(OSError):
        for task in Path(f"/proc/{os.getpid()}/task").iterdir():
            for process in map(int, (task / "children").read_text(encoding="ascii").split()):
                if process not in before:
                    with suppress(OSError):
                        os.waitpid(process, os.WNOHANG)
