"""One worker of a `Pool`: the process, which does tasks, and its parent's handle on it.

    in          the key and the job, then the tasks: a JSON value a line
    out         a sealed message a line: WorkerReady, TaskDone …, perhaps WorkerFailed or
                WorkerDamaged
    heartbeat   words in a file: finished items of the task, a number that grows, milliseconds
                until the next heartbeat is due (0: as usual); moves and name of the item at work

- **A worker ends with its parent.** It is a fork of the launcher, which sees its control end. On
  Linux the kernel kills a worker with the launcher, because a mapper in C code lets no thread
  run; elsewhere the thread that reads tasks sees the channel end.
- **No other program speaks for a worker.** It is shielded from its first moment (launcher.py).
  Each message carries a *seal*: its number and text, signed with a key that only parent and
  worker know. A forged message ends the work.
- A mapper cannot disturb the channel: standard input is empty, prints go to standard error.
- Ctrl-C is for the parent, which ends the workers.
"""

from __future__ import annotations

import ctypes
import importlib
import mmap
import os
import signal
import socket
import threading
import traceback
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, contextmanager, suppress
from functools import partial
from hashlib import blake2b
from hmac import compare_digest
from queue import SimpleQueue
from secrets import token_hex
from tempfile import TemporaryFile
from time import monotonic, sleep
from typing import Any, BinaryIO, Protocol

import msgspec

from topo_verify.errors import HelperLost, InputError
from topo_verify.programs import interruption
from topo_verify.programs.launcher import launch
from topo_verify.robot.stopwatch import Stopwatch, tasks_of


class Beat(Protocol):
    """Called in the course of a task: with the finished items, before anything slow.

    Or, while an item is at work, with its name and its moves, too.
    """

    def __call__(self, items: int, name: str = "", moves: int = 0, /) -> None: ...  # noqa: D102


def no_beat(_items: int, _name: str = "", _moves: int = 0, /) -> None:
    """Do nothing: a `Beat`."""


Handler = Callable[[bytes, Beat], Any]
"""Does one task, given as JSON; msgspec must be able to write the result as JSON."""

Serve = Callable[[bytes], AbstractContextManager[Handler]]
"""Takes the job as JSON and prepares for its tasks."""


def function_at(place: str) -> Any:
    """The function at `module:function`."""
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)


END_GRACE = 5.0
"""Seconds that an idle worker has to leave its context and end."""

LOOK = 1.0
"""Most seconds between two looks of the running pool at a heartbeat."""

TERM_GRACE = 2.0
"""Seconds that a busy worker has to end after SIGTERM."""


class WorkerReady(msgspec.Struct, frozen=True, tag=True):
    """The worker waits for tasks."""


class TaskDone(msgspec.Struct, frozen=True, tag=True):
    """A task is finished."""

    result: msgspec.Raw


class WorkerFailed(msgspec.Struct, frozen=True, tag=True):
    """The worker cannot go on: bad input, a `bug` of ours, or a process that it needs is `lost`."""

    text: str
    bug: bool
    lost: bool = False


class WorkerDamaged(msgspec.Struct, frozen=True, tag=True):
    """An exception after native code had run: that may have damaged this process."""

    text: str


WorkerMessage = WorkerReady | TaskDone | WorkerFailed | WorkerDamaged


NAMED = 200
"""The most bytes of an item's name in a heartbeat."""

NAME = slice(64, 64 + NAMED)


class Heartbeat:
    """The heartbeat, in shared memory, so that machine code can write it at `address`.

    A pipe would fill up while the parent is busy.
    """

    def __init__(self, file: int) -> None:
        self.file = file
        os.ftruncate(file, mmap.PAGESIZE)
        self._memory = mmap.mmap(file, mmap.PAGESIZE)
        self._words = (ctypes.c_int64 * 4).from_buffer(self._memory)
        self.address = ctypes.addressof(self._words)

    def __call__(self, items: int, name: str = "", moves: int = 0, /) -> None:
        """Report the finished items, before the next one begins; or its name and moves so far."""
        if name:
            self._words[3] = moves
            self._memory[NAME] = name.encode(errors="replace")[:NAMED].ljust(NAMED)
        else:
            self._words[0] = items
            self._words[1] += 1
            self._memory[NAME] = b" " * NAMED

    @contextmanager
    def within(self, seconds: float) -> Generator[None]:
        """Allow `seconds` until the next heartbeat, as long as the block runs."""
        self._words[2] = int(1000 * seconds)
        try:
            yield
        finally:
            self._words[2] = 0

    def read(self) -> tuple[int, int, float]:
        """Finished items, beats, and seconds until the next beat is due."""
        items, count, due, _ = self._words
        return items, count, due / 1000

    def at_work(self) -> tuple[str, int]:
        """The name of the item at work, and its moves; "" if it began just now."""
        return self._memory[NAME].decode(errors="ignore").rstrip(), self._words[3]


class Seal:
    """Signs the numbered messages of one worker, against forgery and repetition.

    `process` is the worker's id: a copy of the worker signs nothing.
    """

    def __init__(self, key: str, process: int) -> None:
        self._key, self._process, self._messages = key.encode(), process, 0

    def sealed(self, text: bytes) -> bytes:
        """The next message with its seal."""
        self._messages += 1
        numbered = b"%d %d %b" % (self._process, self._messages, text)
        return blake2b(numbered, key=self._key, digest_size=32).hexdigest().encode() + b" " + text

    def opened(self, line: bytes) -> bytes:
        """The next message without its seal; InputError if that is another's."""
        text = line.partition(b" ")[2]
        if not compare_digest(line, self.sealed(text)):
            raise InputError(
                "expected the seal of a worker on its message, got another one: a process on this"
                " machine writes in its place; run the mapper as another user or in a container"
            )
        return text


# ---------------------------------------------------------------- in the parent


class WorkerProcess:
    """A worker, as its parent sees it; `serve` and `job` are as in `Work`.

    Attributes:
        items, beats: finished items of its task at its last heartbeat, and heartbeats so far.
        due: seconds until its next heartbeat is due; 0: as usual.
    """

    def __init__(self, serve: str, job: object, folder: str | None = None) -> None:
        self._file = TemporaryFile()  # noqa: SIM115  closed by `kill`
        self.heartbeat = Heartbeat(self._file.fileno())
        self.process = launch(f"{__name__}:main", self.heartbeat.file, folder=folder)
        key = token_hex(32)
        self._seal = Seal(key, self.process.pid)
        self.ready = False
        self.items: int = 0
        self.due: float = 0.0
        self.beats: int = 0
        self._since_beat = self._stopwatch()
        self._rest = b""
        self._grace = 0.0
        self._write([key, serve, job])

    @property
    def out(self) -> socket.socket:
        """Its end of the channel."""
        return self.process.channel

    def start(self, task: object) -> None:
        """Hand an idle worker a task; a busy one would not read it."""
        self.items, self._since_beat = 0, self._stopwatch()
        self._write(task)

    def _write(self, data: object) -> None:
        with suppress(ConnectionError):  # it is dead, as reading from it shows
            self.out.sendall(msgspec.json.encode(data) + b"\n")

    def hear(self) -> list[WorkerMessage] | None:
        """The messages that have come; None if it has ended."""
        text = self._received()
        if not text:
            return None
        *lines, self._rest = (self._rest + text).split(b"\n")
        return [msgspec.json.decode(self._seal.opened(line), type=WorkerMessage) for line in lines]

    def _received(self) -> bytes:
        try:
            return self.out.recv(1 << 16)
        except ConnectionError:  # it ended before it read what was written
            return b""

    def silence(self) -> float:
        """Seconds since its last heartbeat, not counting waits for a processor."""
        items, beats, self.due = self.heartbeat.read()
        if beats != self.beats:
            self.items, self.beats, self._since_beat = items, beats, self._stopwatch()
        return self._since_beat.seconds()

    def _stopwatch(self) -> Stopwatch:
        return Stopwatch(lambda: tasks_of(self.process.pid), tick=LOOK)

    def dismiss(self, *, busy: bool) -> None:
        """Let it end: an idle worker leaves its context, a busy one gets SIGTERM."""
        with suppress(OSError):
            self.out.shutdown(socket.SHUT_WR)
        if busy:
            with suppress(ProcessLookupError):
                os.kill(self.process.pid, signal.SIGTERM)
        self._grace = TERM_GRACE if busy else END_GRACE

    def await_end(self) -> None:
        """Wait briefly until it has ended after `dismiss`."""
        until = monotonic() + self._grace
        with suppress(TimeoutError):
            while (seconds := until - monotonic()) > 0:
                self.out.settimeout(seconds)
                if not self._received():
                    return

    def kill(self) -> int:
        """Kill it with its process group; return its exit code, below 0 for a signal."""
        # Its id names no other group: it is not reaped before `wait`.
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid, signal.SIGKILL)
        code = self.process.wait()
        self.silence()
        self.out.close()
        self._file.close()
        return code


# ---------------------------------------------------------------- in the worker


def main(commands: BinaryIO, out: BinaryIO, heartbeat: int) -> None:
    """Work for a parent until it has no more tasks or is gone."""
    lines: SimpleQueue[bytes | None] = SimpleQueue()
    threading.Thread(target=_read, args=(commands, lines.put), daemon=True).start()
    first = lines.get()
    if first is None:
        return
    key, serve, job = msgspec.json.decode(first, type=tuple[str, str, msgspec.Raw])
    send = partial(_send, out, Seal(key, os.getpid()), os.getpid())
    try:
        _work(function_at(serve)(bytes(job)), lines, send, Heartbeat(heartbeat))
    except ConnectionError:
        pass  # the parent is gone, and needs no result
    except (SystemExit, KeyboardInterrupt):
        if not interruption.is_noted():
            raise
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.raise_signal(signal.SIGTERM)  # the status says what ended it
    except InputError as error:
        send(WorkerFailed(str(error), bug=False))
    except HelperLost as error:
        send(WorkerFailed(str(error), bug=False, lost=True))
    except Exception:  # noqa: BLE001  the parent gets it
        send(WorkerFailed(traceback.format_exc(), bug=True))


def _work(
    served: AbstractContextManager[Handler],
    lines: SimpleQueue[bytes | None],
    send: Callable[[WorkerMessage], None],
    beat: Beat,
) -> None:
    with served as handle:
        send(WorkerReady())
        beat(0)
        while (task := lines.get()) is not None:
            beat(0)
            try:
                send(TaskDone(msgspec.Raw(msgspec.json.encode(handle(task, beat)))))
            except ConnectionError:
                raise
            except Exception as error:
                if not _native_code:
                    raise
                with suppress(Exception):
                    send(WorkerDamaged(f"{type(error).__name__}: {error}"))
                os._exit(1)  # no code of ours is safe here, not even that which ends a process


_native_code: list[bool] = []


def native_code_runs() -> None:
    """Say that native code begins to run in this process; an exception from now on may be its."""
    _native_code[:] = [True]


def _send(out: BinaryIO, seal: Seal, process: int, message: WorkerMessage) -> None:
    if os.getpid() != process:
        os._exit(1)  # a fork made by the code that the worker runs
    out.write(seal.sealed(msgspec.json.encode(message)) + b"\n")
    out.flush()


def _read(commands: BinaryIO, put: Callable[[bytes | None], None]) -> None:
    """Hand on the lines; when they end, end the process, even within a task."""
    for line in commands:
        put(line)
    put(None)  # an idle worker sees this, and leaves its context
    sleep(END_GRACE)
    os._exit(1)  # a busy one does not
