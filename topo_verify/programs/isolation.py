"""What keeps a mapper in another process away from the worlds, and how our own children start.

    shield()            this process hides its memory, and its children may not trace
    own_arguments()     the command line is ours: `shield` hides that, too
    sleep_briefly()     this thread sleeps for microseconds, not for tens of them
    hide_arguments()    this process hides its command line, on which a user may have named worlds
    python_command()    a command that runs our own code in a fresh Python
    private_pipes()     in such a process: the pipes to the parent, where no mapper finds them

On Linux a process may read the memory of another one of the same user (/proc/PID/mem), unless that
one says it is not dumpable. A process of root may all the same, if it has the capability to trace;
so that is taken out of what our children can ever have. `shield` is called before the first child
is started, by every process that starts one. A process that is started while a mapper runs must be
shielded from its first moment: launcher.py starts it.

What this does not show: on other systems nothing is hidden. A mapper that runs as root may still
load a kernel module or read the disk; one that runs as the user may read the user's files. The
command line of the shell that started us is not ours to hide.
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
    """Say that the arguments of this process are ours, so that `shield` may hide them."""
    _arguments_are_ours.append(True)


@cache
def shield() -> bool:
    """Make this process undumpable, and its later children unable to trace; whether it worked."""
    if sys.platform != "linux":
        return False
    if _arguments_are_ours:
        hide_arguments()
    # Without CAP_SETPCAP the second call fails; then this process cannot trace others, either.
    _prctl(_PR_CAPBSET_DROP, _CAP_SYS_PTRACE)
    return _prctl(_PR_SET_DUMPABLE, 0) == 0


def sleep_briefly() -> None:
    """Let short sleeps of this thread be as short as they say; Linux adds 50 microseconds."""
    if sys.platform == "linux":
        _prctl(_PR_SET_TIMERSLACK, 1)


def hide_arguments() -> None:
    """Blank the arguments of this process behind the program's name, as others see them.

    Python has copied them to `sys.argv` when it started, and looks at them no more.
    """
    if sys.platform != "linux":
        return
    with suppress(OSError, ValueError, IndexError):
        # What follows the name in brackets, which may itself hold brackets, begins with field 3.
        fields = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        begin, end = int(fields[48 - 3]), int(fields[49 - 3])
        seen = Path("/proc/self/cmdline").read_bytes()
        kept = sum(len(word) + 1 for word in seen.split(b"\0")[:2])  # the Python and the script
        if 0 < begin < end and len(seen) == end - begin > kept:
            ctypes.memset(begin + kept, 0, end - begin - kept)


def end_with(parent: int) -> None:
    """Have the kernel end this process with its parent; end now if that is gone already."""
    if sys.platform == "linux":
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(0)


def _prctl(*arguments: int) -> int:
    library: Any = ctypes.CDLL(None)
    # All five at their full width: the kernel refuses rubbish in those that an option leaves out.
    words = [ctypes.c_ulong(word) for word in (*arguments, 0, 0, 0, 0)[:5]]
    done: int = library.prctl(ctypes.c_int(words[0].value), *words[1:])
    return done


def python_command(place: str, *arguments: str) -> list[str]:
    """The command that calls `module:function` with these arguments in a fresh Python.

    It imports from where this process imports, and from nowhere else: -P leaves out the current
    folder, where a `json.py` of the user's may stand.
    """
    module, _, function = place.partition(":")
    start = (
        "import sys, json; sys.path[:] = json.loads(sys.argv[1]);"
        f"from {module} import {function}; {function}(*sys.argv[2:])"
    )
    return [sys.executable, "-P", "-c", start, json.dumps(sys.path), *arguments]


def private_pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes from and to the parent, moved to where a mapper does not find them.

    A mapper that reads standard input finds nothing, and what it prints goes to standard error.
    """
    commands, out = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return os.fdopen(commands, "rb"), os.fdopen(out, "wb")
