"""One worker of a `Pool`: the process, which does tasks, and the handle that its parent has on it.

    in          the job, then the tasks: a JSON value a line
    out         a message a line: WorkerReady, a TaskDone for each task; or WorkerFailed, the last
    heartbeat   a small file: how many items of the task are finished, and a number that grows

What the process works at is named by `module:function` (`Serve`): the pool, which starts it, knows
nothing of its own of searches, mappers or worlds.

Three things the code here must see to:

- **A worker ends with its parent, however that ends.** On Linux the kernel kills it, for a mapper
  that sits in C code lets no thread run. Elsewhere the thread that reads tasks sees the pipe end.
- **A mapper cannot disturb the pipes.** They are moved away from standard input and output before
  any mapper is loaded; one that reads finds nothing, and what it prints goes to standard error.
- **Ctrl-C is for the parent**, which decides what becomes of the workers.
"""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import threading
import traceback
from collections.abc import Callable
from contextlib import AbstractContextManager, suppress
from queue import SimpleQueue
from tempfile import TemporaryFile
from time import monotonic, sleep
from typing import IO, Any, BinaryIO

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs.isolation import end_with, private_pipes, python_command
from topo_verify.robot.stopwatch import Stopwatch, tasks_of

Beat = Callable[[int], None]
"""Called in the course of a task, before anything that may take long: (items finished so far)."""

Handler = Callable[[bytes, Beat], Any]
"""Does one task: takes it as JSON, returns the result, which msgspec can write as JSON."""

Serve = Callable[[bytes], AbstractContextManager[Handler]]
"""Takes the job as JSON, and prepares for its tasks; on leaving the context, clears up."""

END_GRACE = 5.0
"""Seconds that an idle worker has to leave its context and end."""

TERM_GRACE = 2.0
"""Seconds that a busy worker has to end after SIGTERM."""


class WorkerReady(msgspec.Struct, frozen=True, tag=True):
    """The worker is prepared and waits for tasks."""


class TaskDone(msgspec.Struct, frozen=True, tag=True):
    """A task is finished."""

    result: msgspec.Raw


class WorkerFailed(msgspec.Struct, frozen=True, tag=True):
    """The worker cannot go on: the input is bad, or there is a bug of ours (`bug`)."""

    text: str
    bug: bool


WorkerMessage = WorkerReady | TaskDone | WorkerFailed


class Heartbeat:
    """The file that a worker writes its signs of life to, and its parent reads.

    It is one write of fixed width, so a reader never sees half of one. A pipe would fill up while
    the parent is busy, and would have to be drained; of a file only the last beat is ever read.

    Args:
        file: its file descriptor.
    """

    def __init__(self, file: int) -> None:
        self.file = file
        self._count = 0

    def beat(self, items: int) -> None:
        """Report that so many items of the task are finished, and that something new begins."""
        self._count += 1
        os.pwrite(self.file, b"%12d %12d" % (items, self._count), 0)

    def read(self) -> tuple[int, int]:
        """How many items are finished, and how many beats there were."""
        items, count = os.pread(self.file, 25, 0).split() or (0, 0)
        return int(items), int(count)


# ---------------------------------------------------------------- in the parent


class WorkerProcess:
    """A worker, as its parent sees it. Life cycle: made, `start` tasks, `kill`.

    Args:
        serve: what it is to run, `module:function`; a `Serve`.
        job: what it is handed before its first task.
        folder: where it is started; None: in the current folder.
    Attributes:
        ready: it has said that it waits for tasks.
        items: how many items of its task were finished when its heartbeat was last read.
    """

    def __init__(self, serve: str, job: object, folder: str | None = None) -> None:
        self._file = TemporaryFile()  # noqa: SIM115  closed by `kill`
        self.heartbeat = Heartbeat(self._file.fileno())
        arguments = (serve, str(os.getpid()), str(self.heartbeat.file))
        self.process = subprocess.Popen(  # noqa: S603  this very Python
            python_command(f"{__name__}:main", *arguments),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=[self.heartbeat.file],
            cwd=folder,
            process_group=0,  # Ctrl-C is for the parent; and what a mapper starts is killed with it
        )
        self.ready = False
        self.items: int = 0
        self._beats: int = 0
        self._since_beat = self._stopwatch()
        self._rest = b""
        self._grace = 0.0
        self._write(job)

    @property
    def out(self) -> IO[bytes]:
        """The pipe on which its messages come."""
        assert self.process.stdout is not None
        return self.process.stdout

    def start(self, task: object) -> None:
        """Hand it a task. It must be idle: a busy one would not read, and the pipe may fill up."""
        self.items, self._since_beat = 0, self._stopwatch()
        self._write(task)

    def _write(self, data: object) -> None:
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):  # it is dead: reading from it will tell
            self.process.stdin.write(msgspec.json.encode(data) + b"\n")
            self.process.stdin.flush()

    def hear(self) -> list[WorkerMessage] | None:
        """The messages that have come; None if it has ended."""
        text = os.read(self.out.fileno(), 1 << 16)
        if not text:
            return None
        *lines, self._rest = (self._rest + text).split(b"\n")
        return [msgspec.json.decode(line, type=WorkerMessage) for line in lines]

    def silence(self) -> float:
        """For how many seconds it has written no heartbeat.

        Seconds in which it waits for a processor do not count: a busy machine hangs no worker.
        """
        items, beats = self.heartbeat.read()
        if beats != self._beats:
            self.items, self._beats, self._since_beat = items, beats, self._stopwatch()
        return self._since_beat.seconds()

    def _stopwatch(self) -> Stopwatch:
        return Stopwatch(lambda: tasks_of(self.process.pid))

    def dismiss(self, *, busy: bool) -> None:
        """Have it end: an idle worker leaves its context, a busy one gets SIGTERM."""
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        if busy:
            with suppress(ProcessLookupError):
                os.kill(self.process.pid, signal.SIGTERM)  # `Popen.terminate` may reap it
        self._grace = TERM_GRACE if busy else END_GRACE

    def await_end(self) -> None:
        """Wait until it has ended by itself after `dismiss`, but not for long."""
        until = monotonic() + self._grace
        # It is not reaped here: its number must not name another group when `kill` uses it.
        options = os.WEXITED | os.WNOWAIT | os.WNOHANG
        while os.waitid(os.P_PID, self.process.pid, options) is None and monotonic() < until:
            sleep(0.002)

    def kill(self) -> str:
        """Kill it and whatever it started; its exit status in words."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid, signal.SIGKILL)
        code = self.process.wait()
        self.silence()  # how far it came
        for pipe in (self.process.stdin, self.process.stdout, self._file):
            if pipe is not None:
                with suppress(BrokenPipeError):
                    pipe.close()
        return f"signal {-code}" if code < 0 else f"exit code {code}"


# ---------------------------------------------------------------- in the worker


def main(serve: str, parent: str, heartbeat: str) -> None:
    """Work for a parent until it has no more tasks or is gone.

    Args:
        serve: `module:function`, a `Serve`.
        parent: its process id.
        heartbeat: the file descriptor of the heartbeat.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with(int(parent))
    commands, out = private_pipes()
    lines: SimpleQueue[bytes | None] = SimpleQueue()
    threading.Thread(target=_read, args=(commands, lines.put), daemon=True).start()
    try:
        job = lines.get()
        if job is not None:
            _work(_function(serve)(job), lines, out, Heartbeat(int(heartbeat)).beat)
    except BrokenPipeError:
        pass  # the parent is gone: nobody wants the result
    except InputError as error:
        _send(out, WorkerFailed(str(error), bug=False))
    except Exception:  # noqa: BLE001  whatever it is, the parent is told
        _send(out, WorkerFailed(traceback.format_exc(), bug=True))


def _work(
    served: AbstractContextManager[Handler],
    lines: SimpleQueue[bytes | None],
    out: BinaryIO,
    beat: Beat,
) -> None:
    """Do tasks until there are no more."""
    with served as handle:
        _send(out, WorkerReady())
        beat(0)
        while (task := lines.get()) is not None:
            beat(0)
            _send(out, TaskDone(msgspec.Raw(msgspec.json.encode(handle(task, beat)))))


def _function(name: str) -> Serve:
    module, _, attribute = name.partition(":")
    found: Serve = getattr(importlib.import_module(module), attribute)
    return found


def _send(out: BinaryIO, message: WorkerMessage) -> None:
    out.write(msgspec.json.encode(message) + b"\n")
    out.flush()


def _read(commands: BinaryIO, put: Callable[[bytes | None], None]) -> None:
    """Hand on the lines; when they end, have the process end, in the midst of a task or not."""
    for line in commands:
        put(line)
    put(None)  # an idle worker sees this, and leaves its context
    sleep(END_GRACE)
    os._exit(1)  # a busy one does not
