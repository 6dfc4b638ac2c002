"""Ends programs whose harness is gone: so that a harness that is killed leaves nothing behind.

A process of its own, in its own session, with nothing but the standard library. It reads lines,
`+ group mark` when a program is started and `- group mark` when one was ended; when its input ends,
whoever wrote it has ended, and what is still on the list is killed. It is no part of the package at
run time: `python -I -S warden.py`.

A **mark** is the value of an environment variable that a program's descendants inherit. By it those
are found that moved to a process group of their own (Linux only: elsewhere /proc is not there).

What this does not show: a descendant that leaves its group AND empties its environment is lost.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

MARK = "TOPO_VERIFY_PROGRAM"
"""The environment variable that holds the mark."""


def end_all(group: int, mark: str) -> None:
    """Kill a process group, and whoever else carries the mark."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(group, signal.SIGKILL)
    for _ in range(3):  # a process may have been born while the list was read
        carriers = marked(mark)
        for process in carriers:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(process, signal.SIGKILL)
        if not carriers:
            return


def marked(mark: str) -> list[int]:
    """The living processes that carry the mark."""
    wanted = f"{MARK}={mark}".encode()
    found: list[int] = []
    with suppress(OSError):
        for process in Path("/proc").iterdir():
            with suppress(OSError, ValueError):  # no process; another user's; gone already
                if wanted in (process / "environ").read_bytes().split(b"\0"):
                    found.append(int(process.name))
    return found


def main() -> None:
    """Read the list until it ends, and end what is left on it."""
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, signal.SIG_IGN)
    living: dict[str, int] = {}
    for line in sys.stdin:
        sign, group, mark = line.split()
        if sign == "+":
            living[mark] = int(group)
        else:
            living.pop(mark, None)
    for mark, group in living.items():
        end_all(group, mark)


if __name__ == "__main__":
    main()
