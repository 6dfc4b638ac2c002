"""Starts processes of our own that no other program can ever look into.

**Why a launcher.** Until a new Python becomes undumpable, every process of the user can read it
(/proc/PID/mem, /proc/PID/fd, ptrace, pidfd_getfd). Files opened by then stay open, and a process
traced by then obeys its tracer, so no key closes this gap. But a *fork inherits* undumpability. So
the launcher is started and shielded before any foreign program, and workers are its forks. It has
one thread, so it can always fork. It imports what workers need once for all of them.

**Why not a library?** `multiprocessing.forkserver` listens on a named socket, to which any process
of the user can connect, and it shields nothing.

    control    to the launcher: start a fork with these files; wait for the end of a fork
    channel    to each fork: a pair of sockets; the first line says what the fork does

The launcher ends with its parent, and its forks with the launcher. If it is killed after a foreign
program was started, it is not replaced: a new one would have an unshielded first moment.

What this does not show: a process of an *earlier* command runs beside that first moment. On other
systems than Linux nothing is hidden.
"""

from __future__ import annotations

import atexit
import importlib
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress

from topo_verify.errors import HelperLost, InternalError
from topo_verify.programs import isolation

_ORDER = struct.Struct("=qcq")
"""Order to the launcher: its number, `_START` or `_WAIT`, the process to wait for."""

_ANSWER = struct.Struct("=qq")
"""Answer: the order's number; the process id, or how the process ended."""

_START, _WAIT, _READY = b"+", b"-", b"."

_MOST_FILES = 8


class Launched:
    """A process started by the launcher; its `pid` is not reused before `wait`."""

    def __init__(self, launcher: _Launcher, pid: int, channel: socket.socket) -> None:
        self._launcher, self.pid, self.channel = launcher, pid, channel

    def wait(self) -> int:
        """Wait for its end; return the exit code, or a signal as a negative number."""
        try:
            return self._launcher.ask(_WAIT, self.pid)
        except _Lost:
            return -signal.SIGKILL  # the kernel ended it with the launcher


def prepare() -> None:
    """Shield this process and start the launcher, so that foreign code may run from now on."""
    if not _forked:
        _launcher().foreign = True


def warm_up(module: str) -> None:
    """Start the launcher, if there is none, and have it import a module of ours meanwhile."""
    _launcher(module)


def launch(place: str, *files: int, folder: str | None = None) -> Launched:
    """Start a process that calls `module:function`, with a channel and these files.

    Args:
        folder: where it runs; default: the current folder.
    Raises:
        HelperLost: the launcher was killed after a program was started.
        OSError: the system starts no process.
    """
    ours, theirs = socket.socketpair()
    try:
        with theirs, open(os.devnull, "wb") as nothing:  # noqa: PTH123  as raw as the others
            error = 2 if _is_open(2) else nothing.fileno()
            launcher, pid = _started((theirs.fileno(), error, *files))
    except BaseException:
        ours.close()
        raise
    task = [place, sys.path, dict(os.environ), _absolute(folder or ".")]
    with suppress(ConnectionError):  # it is dead: reading from it will tell
        ours.sendall(json.dumps(task).encode() + b"\n")
    return Launched(launcher, pid, ours)


def _started(files: Sequence[int]) -> tuple[_Launcher, int]:
    while True:  # a launcher killed before any foreign program is replaced
        launcher = _launcher()
        with suppress(_Lost):
            return launcher, launcher.ask(_START, files=files)


def _is_open(file: int) -> bool:
    with suppress(OSError):
        os.fstat(file)
        return True
    return False


def _absolute(folder: str) -> str | None:
    with suppress(OSError):  # it was removed; the launcher is in it, too
        return os.path.abspath(folder)  # noqa: PTH100  a text
    return None


# ---------------------------------------------------------------- in the process that has it


class _Lost(Exception):
    pass


class _Launcher:
    """The launcher of this process.

    Attributes:
        owner: the process that started it; a fork of that starts its own launcher.
        foreign: a foreign program was started since.
    """

    def __init__(self, module: str) -> None:
        isolation.shield()
        self.owner, self.foreign = os.getpid(), False
        self._orders, self._lock = 0, threading.Lock()
        self._control, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(  # noqa: S603  this very Python
                isolation.python_command(f"{__name__}:main", module),
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                process_group=0,
            )
        if self._control.recv(1) != _READY:
            raise InternalError("the process that starts workers ended before it was ready")

    @property
    def lost(self) -> bool:
        return self._process.poll() is not None

    def ask(self, kind: bytes, process: int = 0, files: Sequence[int] = ()) -> int:
        """The answer to an order; raises `_Lost`, or OSError if no process starts."""
        with self._lock:
            self._orders += 1
            order = _ORDER.pack(self._orders, kind, process)
            answer = (0, 0)
            try:
                socket.send_fds(self._control, [order], files)
                while answer[0] != self._orders:  # Ctrl-C left an answer unread
                    answer = _ANSWER.unpack(self._control.recv(_ANSWER.size))
            except (ConnectionError, struct.error):
                self._process.wait()
                raise _Lost from None
        if kind == _START and answer[1] < 0:
            raise OSError(-answer[1], os.strerror(-answer[1]))
        return answer[1]

    def close(self) -> None:
        self._control.close()
        if self.owner == os.getpid():
            self._process.wait()


_launchers: list[_Launcher] = []
_starting = threading.Lock()
_forked: list[bool] = []
"""Not empty in a fork of a launcher, which starts no forks itself."""


def _launcher(module: str = __name__) -> _Launcher:
    with _starting:
        if _launchers and _launchers[-1].owner == os.getpid():
            require_launcher()
            if not _launchers[-1].lost:
                return _launchers[-1]
        launcher = _Launcher(module)
        _launchers.append(launcher)
        atexit.register(launcher.close)
        return launcher


def require_launcher() -> None:
    """Raise HelperLost if the launcher was killed after a program was started."""
    if _launchers and _launchers[-1].foreign and _launchers[-1].lost:
        raise HelperLost(
            "a signal ended the process that starts workers, and none can be started beside a"
            " mapper: start the command again"
        )


# ---------------------------------------------------------------- in the launcher


def main(module: str) -> None:
    """Start forks and wait for them, until the parent is gone; a fork goes on to its task.

    Imports the module first: a fork has it then.
    """
    isolation.shield()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    control = socket.socket(fileno=os.dup(0))
    with open(os.devnull, "rb") as nothing:  # noqa: PTH123  as raw as the others
        os.dup2(nothing.fileno(), 0)
    control.sendall(_READY)
    importlib.import_module(module)
    here = os.getpid()
    while True:
        order, files, _, _ = socket.recv_fds(control, _ORDER.size, _MOST_FILES)
        if not order:
            return
        number, kind, process = _ORDER.unpack(order)
        if kind == _WAIT:
            _, status = os.waitpid(process, 0)
            answer = os.waitstatus_to_exitcode(status)
        else:
            try:
                answer = os.fork()
            except OSError as error:
                answer = -(error.errno or 1)
            if answer == 0:
                control.close()
                isolation.end_with(here)
                os.setpgid(0, 0)
                _play(*files)
                return
            for file in files:
                os.close(file)
            with suppress(OSError):
                os.setpgid(answer, answer)
        control.sendall(_ANSWER.pack(number, answer))


def _play(channel: int, error: int, *files: int) -> None:
    _forked.append(True)
    for file in (channel, *files):
        os.set_inheritable(file, False)  # noqa: FBT003  its only argument
    for stream in (1, 2):
        os.dup2(error, stream)
    os.close(error)
    # Neither is ever closed: a thread may read from one until this process ends.
    reader, writer = os.fdopen(channel, "rb"), os.fdopen(os.dup(channel), "wb")
    task = reader.readline()
    if not task.endswith(b"\n"):
        return
    place, path, environment, folder = json.loads(task)
    sys.path[:] = path
    os.environ.clear()
    os.environ.update(environment)
    if folder is not None:
        os.chdir(folder)
    module, _, function = place.partition(":")
    getattr(importlib.import_module(module), function)(reader, writer, *files)
