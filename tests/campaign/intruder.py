"""A mapper that delivers nothing to workers, and a thread that could answer in their place.

The first process that loads it is kept by the process that runs the search. From its first line on,
a thread there tries to get hold of every process of ours that it can find, again and again: to open
its memory and its files, and to take its files over. The mapper of a worker waits until the thread
has tried that worker. Then it kills the first worker, so that another one is started beside the
thread, and delivers nothing to the second.

What the thread got hold of stands in the file `opened`; `refused` has the others' numbers.
"""

from __future__ import annotations

import ctypes
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from topo_verify import Robot
from topo_verify.algorithms import algorithm

STARTED_BY = (b".worker import", b"programs.launcher import")
"""On the command line of a worker, and of what starts workers."""

PATIENCE = 60.0
PIDFD_GETFD = 438


def ours(search: int) -> Iterator[int]:
    """The processes that judge in this search: itself, its workers, and what starts them."""
    yield search
    for folder in Path("/proc").iterdir():
        with suppress(OSError, ValueError):
            process = int(folder.name)
            if is_ours(process) and search in (parent(process), parent(parent(process))):
                yield process


def is_ours(process: int) -> bool:
    """Whether the command line of a process says that it is a worker, or starts workers."""
    command = Path(f"/proc/{process}/cmdline").read_bytes()
    return any(words in command for words in STARTED_BY)


def parent(process: int) -> int:
    """The parent of a process."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return int(fields[1])


def got(process: int) -> list[int]:
    """Files of a process, and its memory, as far as it can be had."""
    files: list[int] = []
    with suppress(OSError):
        files.append(os.open(f"/proc/{process}/mem", os.O_RDWR))
    for number in range(12):
        with suppress(OSError):
            files.append(os.open(f"/proc/{process}/fd/{number}", os.O_WRONLY))
        with suppress(OSError):
            pidfd = os.pidfd_open(process)
            file = ctypes.CDLL(None).syscall(PIDFD_GETFD, pidfd, number, 0)
            files += [file] if file >= 0 else []
            os.close(pidfd)
    return files


def attack() -> None:
    """Try every process of ours, again and again."""
    tried: set[int] = set()
    search = os.getppid()
    while True:
        for process in ours(search):
            files = got(process)
            if files:
                with Path("opened").open("a") as file:
                    print(process, len(files), file=file)
                for number in files:
                    os.close(number)
            elif process not in tried and os.path.exists(f"/proc/{process}"):  # noqa: PTH110
                tried.add(process)
                with Path("refused").open("a") as file:
                    print(process, file=file)


def told(name: str, process: int) -> bool:
    """Whether a file names a process."""
    with suppress(OSError):
        return str(process) in Path(name).read_text().split()
    return False


def is_first(name: str) -> bool:
    """Whether this is the first call with this name."""
    with suppress(FileExistsError):
        Path(name).touch(exist_ok=False)
        return True
    return False


ATTACKS = is_first("attacks")
if ATTACKS:
    threading.Thread(target=attack, daemon=True).start()


def explore(robot: Robot) -> object:
    """Wait for the thread, and deliver nothing."""
    worker, until = os.getppid(), time.monotonic() + PATIENCE
    if not is_ours(worker):
        return algorithm("basic")(robot)  # the search runs some worlds again
    while not (told("refused", worker) or told("opened", worker)) and time.monotonic() < until:
        time.sleep(0.01)
    if is_first("killed"):
        os.kill(worker, signal.SIGKILL)
    return None
