"""A process that examines shards for its parent: commands come in on one pipe, tallies go out.

    in      the plan, then a shard a line, each as JSON
    out     Ready, then one Done for each shard; or Failed, the last word
    pulse   a file of one line: how many worlds of the shard are done, and a number that grows; the
            parent looks it up to see how far the work is, that it goes on, and where it stood when
            it died

A worker must not outlive its parent, not even one that was killed. A thread reads the commands:
when the pipe ends, the process does. And on Linux the kernel is asked to end it with its parent: a
mapper that sits in C code would not let the thread run.

Standard input and output belong to the pipes; a mapper that reads finds nothing, and what it prints
goes to stderr.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from queue import SimpleQueue
from typing import BinaryIO

import msgspec

from topo_verify.errors import InputError
from topo_verify.harness.search.identity import source_hash
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.search.shard import examine_shard
from topo_verify.harness.tally import Tally
from topo_verify.harness.targets import targets

PR_SET_PDEATHSIG = 1


class Ready(msgspec.Struct, frozen=True, tag=True):
    """The mappers are loaded; from which sources."""

    sources: str


class Done(msgspec.Struct, frozen=True, tag=True):
    """A shard is done."""

    tally: Tally


class Failed(msgspec.Struct, frozen=True, tag=True):
    """It cannot go on: bad input, or a bug of ours."""

    text: str
    bug: bool


Message = Ready | Done | Failed


class Pulse:
    """The pulse file, written by a worker (`beat`) and read by its parent (`read`)."""

    def __init__(self, file: int) -> None:
        self.file = file
        self._count = 0

    def beat(self, worlds: int) -> None:
        """So many worlds of the shard are done, and the next thing begins."""
        self._count += 1
        os.pwrite(self.file, b"%12d %12d" % (worlds, self._count), 0)

    def read(self) -> tuple[int, int]:
        """How many worlds are done, and how many beats there were."""
        worlds, count = os.pread(self.file, 25, 0).split() or (0, 0)
        return int(worlds), int(count)


def main(parent: int, pulse: int) -> None:
    """Work for the parent with this process id until it has no more work.

    Args:
        pulse: the file descriptor of the pulse.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent hears it, and decides
    _end_with(parent)
    commands, out = _pipes()
    lines: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read, args=(commands, lines.put), daemon=True).start()
    try:
        plan = msgspec.json.decode(lines.get(), type=Plan)
        mappers = [target for text in plan.targets for target in targets(text)]
        _send(out, Ready(source_hash(mappers)))
        beat = Pulse(pulse).beat
        while True:
            beat(0)
            shard = msgspec.json.decode(lines.get(), type=Shard)
            _send(out, Done(examine_shard(plan, mappers, shard, beat)))
    except InputError as error:
        _send(out, Failed(str(error), bug=False))
    except Exception:  # noqa: BLE001  whatever it is, the parent is told
        _send(out, Failed(traceback.format_exc(), bug=True))


def _send(out: BinaryIO, message: Message) -> None:
    """One message, at once."""
    out.write(msgspec.json.encode(message) + b"\n")
    out.flush()


def _pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes, moved to where a mapper does not find them."""
    commands, out = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    return os.fdopen(commands, "rb"), os.fdopen(out, "wb")


def _read(commands: BinaryIO, put: Callable[[bytes], None]) -> None:
    """Hand on what comes in; at its end, end."""
    for line in commands:
        put(line)
    os._exit(0)


def _end_with(parent: int) -> None:
    """Ask the kernel to end this process with its parent; end now if it is gone."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(0)
