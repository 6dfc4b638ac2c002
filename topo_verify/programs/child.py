"""A program as a child process: its lines in and out, and its end, whatever it does.

The program runs in a session of its own. It may flood a stream, close it, stop reading, ignore
signals, start children: what is kept of its output is bounded, nothing here waits for it longer
than a tick without running Python code (so a time limit can strike), and `end` leaves nothing of it
behind.

    one move     write, poll, read: three system calls

Vocabulary: a *line* is a message with its line end cut off; the *tail* is the end of what came on
standard error.
"""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from math import inf
from pathlib import Path
from secrets import token_hex
from time import monotonic, sleep

from topo_verify.errors import InputError
from topo_verify.programs import reaper
from topo_verify.programs.protocol import LIMIT
from topo_verify.robot.limits import TICK
from topo_verify.robot.stopwatch import Stopwatch, tasks_of

GRACE = 0.3
"""Seconds between SIGTERM and SIGKILL, and for a program to end by itself when it should."""

LAST_WORDS = 0.5
"""Seconds that a program has to end once its output has."""

TAIL = 4096
"""Bytes of standard error that are kept."""

CHUNK = 2**16

AHEAD = 4 * LIMIT
"""So many bytes may a program write while it does not read."""

LOOKS = 30
"""So often it is looked for an answer before sleeping: most come sooner than one is woken."""


class Ended(Exception):
    """The program's output has ended."""


class Silent(Exception):
    """No line came for as long as was waited."""


class TooLong(Exception):
    """A line, or what was written while nobody could read it, is longer than is allowed."""


class Warden:
    """The process that ends programs whose harness was killed; one for any number of programs."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(  # noqa: S603  our own file
            [sys.executable, "-I", "-S", str(Path(reaper.__file__))],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            bufsize=0,
        )

    def tell(self, sign: str, group: int, mark: str) -> None:
        """A program was started (`+`) or ended (`-`)."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(f"{sign} {group} {mark}\n".encode())

    def close(self) -> None:
        """It is not needed any more."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        self._process.wait()


class Child:
    """A running program. Life cycle: made, `write` and `line` in any order, `end` once or more.

    Args:
        command: the program and its arguments; no shell looks at them.
        guard: told of its birth and its end.
    Raises:
        InputError: it cannot be started.
    """

    def __init__(self, command: Sequence[str], guard: Warden) -> None:
        self.mark = token_hex(16)
        try:
            self._process = subprocess.Popen(  # noqa: S603  the user names it, no shell reads it
                list(command),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={**os.environ, reaper.MARK: self.mark},
                start_new_session=True,
                bufsize=0,
            )
        except (OSError, ValueError) as error:
            reason = (isinstance(error, OSError) and error.strerror) or error
            raise InputError(
                f"--cmd: cannot start {command[0]!r}: {reason}; name a program that can be run"
            ) from error
        self._guard = guard
        guard.tell("+", self._process.pid, self.mark)
        streams = (self._process.stdin, self._process.stdout, self._process.stderr)
        self._in, self._out, self._err = (s.fileno() for s in streams if s is not None)
        self._poll = select.poll()
        for stream in (self._in, self._out, self._err):
            os.set_blocking(stream, False)
        self._poll.register(self._out, select.POLLIN)
        self._poll.register(self._err, select.POLLIN)
        self._lines: deque[bytes] = deque()
        self._rest = bytearray()
        self._tail = bytearray()
        self._over = False  # its output has ended
        self._complaints = 0  # bytes on standard error so far
        self.deaf = False  # it reads no more, or is to be written no more
        self._ended = False

    @property
    def process(self) -> int:
        """The number of its process."""
        return self._process.pid

    # ------------------------------------------------------------ lines

    def line(self, *, seconds: float = inf) -> bytes:
        """The next line, as soon as it is there.

        Args:
            seconds: how long to wait for it, without what it waits for a processor.
        Raises:
            Silent: it did not come.
            Ended: there is none, its output has ended (perhaps in the middle of a line: `half`).
            TooLong: more bytes than a message may have.
        """
        clock = None if seconds == inf or self._lines else Stopwatch(lambda: tasks_of(self.process))
        while not self._lines:
            if self._over:
                raise Ended
            if clock is not None and clock.seconds() > seconds:
                raise Silent
            if not self._listen() and self._status() is not None:
                self._over = True  # a child of its own may hold the stream open, and is silent
        return self._lines.popleft()

    def write(self, data: bytes) -> None:
        """Hand it a line. A program that reads no more is not told; its output may say why."""
        while data and not self.deaf:
            try:
                data = data[os.write(self._in, data) :]
            except BlockingIOError:
                self._wait_for_room()
            except OSError:  # a broken pipe
                self.deaf = True

    def close_input(self) -> None:
        """Nothing more will be written."""
        if not self.deaf:
            self.deaf = True
            assert self._process.stdin is not None
            self._process.stdin.close()

    @property
    def flooded(self) -> bool:
        """Has it written more on standard error than a message may have?"""
        return self._complaints > LIMIT

    @property
    def half(self) -> bool:
        """Has it begun a line that it did not end?"""
        return bool(self._rest)

    @property
    def has_line(self) -> bool:
        """Is there a line? Looks what is there."""
        if not self._lines and not self._over:
            self._listen(0)
        return bool(self._lines)

    @property
    def pending(self) -> bytes:
        """What has come, and nobody has asked for: the first line of it."""
        return self._lines[0] if self._lines else bytes(self._rest)

    @property
    def speaks(self) -> bool:
        """Has anything come that nobody asked for? Looks what is there."""
        return self.has_line or bool(self._rest)

    def _listen(self, seconds: float = TICK) -> bool:
        """Take what is there, wait a tick for it; was there anything?"""
        ready, looks = self._poll.poll(0), LOOKS if seconds else 0
        while not ready and looks:
            ready, looks = self._poll.poll(0), looks - 1
        ready = ready or self._poll.poll(int(1000 * seconds))
        for stream, _ in ready:
            if stream == self._out:
                self._take()
            elif stream == self._err:
                self._drain()
        return bool(ready)

    def _take(self) -> None:
        try:
            chunk = os.read(self._out, CHUNK)
        except BlockingIOError:
            return
        if not chunk:
            self._over = True
            self._poll.unregister(self._out)
            return
        first, *more = chunk.split(b"\n")
        if self._rest or not more:
            self._rest += first
            if len(self._rest) > LIMIT:
                raise TooLong
            if not more:
                return
            first = bytes(self._rest)
            self._rest.clear()
        self._lines.append(first)
        self._rest += more.pop()
        self._lines.extend(more)

    def _drain(self) -> None:
        try:
            chunk = os.read(self._err, CHUNK)
        except BlockingIOError:
            return
        if not chunk:
            self._poll.unregister(self._err)
        self._complaints += len(chunk)
        self._tail += chunk
        del self._tail[:-TAIL]

    def _wait_for_room(self) -> None:
        """Let the program write while it does not read, so that neither waits for the other."""
        self._poll.register(self._in, select.POLLOUT)
        try:
            self._listen()
        finally:
            self._poll.unregister(self._in)
        if len(self._rest) + sum(map(len, self._lines)) > AHEAD:
            raise TooLong

    # ------------------------------------------------------------ its end

    def fate(self) -> str | None:
        """How it ended, in words, if it does so soon; None if it goes on."""
        until = monotonic() + LAST_WORDS
        while (status := self._status()) is None:
            if monotonic() > until:
                return None
            self._listen(0)
            sleep(0.001)
        code, number = status
        if code == os.CLD_EXITED:
            return f"ended with exit code {number}"
        with suppress(ValueError):
            return f"was ended by {signal.Signals(number).name}"
        return f"was ended by signal {number}"

    def stderr(self) -> str:
        """The end of what it wrote on standard error."""
        with suppress(OSError, KeyError):  # KeyError: its end was seen already
            while any(stream == self._err for stream, _ in self._poll.poll(0)):
                self._drain()
        return self._tail.decode(errors="backslashreplace")

    def _status(self) -> tuple[int, int] | None:
        """How it ended, without laying it to rest: its number stays its own until `end`."""
        found = os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT | os.WNOHANG)
        return None if found is None else (found.si_code, found.si_status)

    def end(self, *, politely: float = 0.0) -> None:
        """End it and whatever it has started; afterwards nothing of it is left.

        Args:
            politely: seconds that it has to end by itself before it is told to.
        """
        if self._ended:
            return
        self._await_end(politely)
        if self._status() is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGTERM)
            self._await_end(GRACE)
        reaper.end_all(self._process.pid, self.mark)
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        self._guard.tell("-", self._process.pid, self.mark)
        self._ended = True

    def _await_end(self, seconds: float) -> None:
        until = monotonic() + seconds
        while self._status() is None and monotonic() < until:
            sleep(0.002)
