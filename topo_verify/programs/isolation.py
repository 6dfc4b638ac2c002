"""Keeps a mapper in another process away from the worlds.

On Linux a process may read the memory of another one of the same user, unless that one is not
dumpable. Root may do so with the capability to trace, so our children lose it.

What this does not show: on other systems nothing is hidden. A mapper of root may load a kernel
module or read the disk; one of the user may read the user's files. The command line of the shell
that started us stays visible.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_CAPBSET_DROP, _PR_SET_TIMERSLACK = 1, 4, 24, 29
_CAP_SYS_PTRACE = 19


_arguments_are_ours: list[bool] = []


def own_arguments() -> None:
    """Let `shield` hide the arguments of this process."""
    _arguments_are_ours.append(True)


@cache
def shield() -> bool:
    """Make this process undumpable, and its later children unable to trace; True if it worked.

    Every process calls it before it starts its first child.
    """
    if sys.platform != "linux":
        return False
    if _arguments_are_ours:
        hide_arguments()
    # Without CAP_SETPCAP this call fails; then this process cannot trace others, either.
    _prctl(_PR_CAPBSET_DROP, _CAP_SYS_PTRACE)
    return _prctl(_PR_SET_DUMPABLE, 0) == 0


def sleep_briefly() -> None:
    """Let short sleeps of this thread be exact; Linux adds 50 microseconds by default."""
    if sys.platform == "linux":
        _prctl(_PR_SET_TIMERSLACK, 1)


def hide_arguments() -> None:
    """Blank the arguments of this process, in which a user may have named worlds."""
    if sys.platform != "linux":
        return
    with suppress(OSError, ValueError, IndexError):
        # Field 3 follows the name in brackets, which may itself hold brackets.
        fields = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        begin, end = int(fields[48 - 3]), int(fields[49 - 3])
        line = Path("/proc/self/cmdline").read_bytes()
        kept = sum(len(word) + 1 for word in line.split(b"\0")[:2])
        if 0 < begin < end and len(line) == end - begin > kept:
            ctypes.memset(begin + kept, 0, end - begin - kept)


def end_with(parent: int) -> None:
    """Have the kernel end this process with its parent; end now if that is gone."""
    if sys.platform == "linux":
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(0)


def _prctl(*arguments: int) -> int:
    library: Any = ctypes.CDLL(None)
    # All five at full width: the kernel refuses rubbish in unused ones.
    words = [ctypes.c_ulong(word) for word in (*arguments, 0, 0, 0, 0)[:5]]
    done: int = library.prctl(ctypes.c_int(words[0].value), *words[1:])
    return done


def python_command(place: str, *arguments: str) -> list[str]:
    """The command that calls `module:function` with these arguments in a fresh Python.

    -P leaves out the current folder, which may hold a `json.py` of the user.
    """
    module, _, function = place.partition(":")
    start = (
        "import sys, json; sys.path[:] = json.loads(sys.argv[1]);"
        f"from {module} import {function}; {function}(*sys.argv[2:])"
    )
    return [sys.executable, "-P", "-c", start, json.dumps(sys.path), *arguments]


def private_pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes from and to the parent; prints go to standard error, standard input is empty."""
    commands, out = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return os.fdopen(commands, "rb"), os.fdopen(out, "wb")
