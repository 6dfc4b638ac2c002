"""Kills the programs that a harness leaves behind when the harness itself is killed.

The reaper runs in its own session, which a signal to the harness does not reach. It reads
`+ group mark` when a program was started, `- group mark` when it was ended. At the end of its input
it kills the programs still on its list.

A **mark** is the value of an environment variable that descendants inherit. It finds those that
moved to another process group (only on Linux: it needs /proc).

What this does not show: a descendant that leaves its group AND clears its environment escapes.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

MARK = "TOPO_VERIFY_PROGRAM"


def end_all(group: int | None, mark: str) -> None:
    """Kill a process group, if one is given, and every process that carries the mark."""
    if group is not None:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(group, signal.SIGKILL)
    for _ in range(3):  # a process may have forked while /proc was read
        carriers = marked(mark)
        for process in carriers:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(process, signal.SIGKILL)
        if not carriers:
            return


def marked(mark: str) -> list[int]:
    """The ids of the living processes that carry the mark."""
    wanted = f"{MARK}={mark}".encode()
    carriers: list[int] = []
    with suppress(OSError):
        for process in Path("/proc").iterdir():
            with suppress(OSError, ValueError):  # not a process, another user's, or ended by now
                if wanted in (process / "environ").read_bytes().split(b"\0"):
                    carriers.append(int(process.name))
    return carriers


def main() -> None:
    """Keep the list of programs until the input ends, then kill those on it."""
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
