"""A program as a child process: lines to it, lines from it, and its end.

The program runs in its own session. It may flood a stream, close it, stop reading, ignore
signals, or start children. Against all of these hold three invariants: the kept output is bounded;
nothing here blocks for longer than a tick, so that a time limit can strike between two ticks; `end`
leaves no process behind.

    one move     write, poll, read: three system calls

Harness and program take turns, so they are fastest on one processor: the kernel switches from one
to the other in a few microseconds, while a processor that idles takes tens of them to wake up. A
program with a single thread is therefore kept on the processor of the harness (process.py), where
a poll sleeps at once. Others run where they like, and a poll looks some hundred times before it
sleeps.

Vocabulary: a *line* is a message without its line end; the *tail* is the end of standard error.
"""

from __future__ import annotations

import fcntl
import os
import select
import signal
import subprocess
import sys
import termios
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from math import inf
from pathlib import Path
from secrets import token_hex
from time import monotonic, sleep

from topo_verify.errors import InputError
from topo_verify.programs import launcher, reaper
from topo_verify.programs.isolation import sleep_briefly
from topo_verify.programs.process import ExitStatus, SharedProcessor, StandardError, exit_status
from topo_verify.programs.protocol import LIMIT
from topo_verify.robot.limits import TICK
from topo_verify.robot.stopwatch import Stopwatch, tasks_of

GRACE = 0.3
"""Seconds between SIGTERM and SIGKILL; also the time to end after a `stop` message."""

LAST_WORDS = 2.0
"""Seconds between the end of a program's output and its exit status, at most."""

CHUNK = 2**16

HEAD = b'{"type":"'
"""The first bytes of every message to a program."""

AHEAD = 4
"""Unread output may hold `AHEAD` messages of the greatest length."""

PAUSE = 2e-5
"""Seconds by which each pause is longer than the one before, while a program does not read."""

_NO_BYTES = bytes(4)

LOOKS = 200
"""Polls without waiting before a poll that sleeps, where the program has another processor."""

BUSY = 5e-4
"""Most seconds that a look takes on a processor without other work."""


class Ended(Exception):
    """The program's output has ended, so no line will come."""


class Silent(Exception):
    """No line came in the time given."""


class TooLong(Exception):
    """The program wrote a line that is too long, or too many lines without reading."""


class Child:
    """A running program. Life cycle: construction starts it; `write`, `line`; `end` once or more.

    Args:
        command: the program and its arguments; no shell expands them.
        reaper_process: kills the program if this process is killed.
        longest: the most bytes of a line.
        echo: what it writes on standard error appears on ours, each line behind this mark.
    Attributes:
        heard: how often its output was read.
    Raises:
        InputError: the program cannot be started.
    """

    def __init__(
        self,
        command: Sequence[str],
        reaper_process: ReaperProcess,
        *,
        longest: int = LIMIT,
        echo: str | None = None,
    ) -> None:
        launcher.prepare()
        self.mark = token_hex(16)
        self._longest = longest
        try:
            self._process = subprocess.Popen(  # noqa: S603  the user names it, no shell reads it
                list(command),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={**os.environ, reaper.MARK: self.mark},
                start_new_session=True,  # a group to kill, which Ctrl-C does not reach
                bufsize=0,
            )
        except (OSError, ValueError) as error:
            reason = (isinstance(error, OSError) and error.strerror) or error
            raise InputError(
                f"--cmd: cannot start {command[0]!r}: {reason}; name a program that can be run"
            ) from error
        self._reaper = reaper_process
        reaper_process.started(self._process.pid, self.mark)
        streams = (self._process.stdin, self._process.stdout, self._process.stderr)
        self._in, self._out, self._err = (s.fileno() for s in streams if s is not None)
        self._poll = select.poll()
        for stream in (self._in, self._out, self._err):
            os.set_blocking(stream, False)
        self._poll.register(self._out, select.POLLIN)
        self._poll.register(self._err, select.POLLIN)
        self._readers = select.poll()  # tells when no process can read our messages any more
        self._readers.register(self._in, 0)
        self._head_sent = False
        self._processor = SharedProcessor(self._process.pid)
        sleep_briefly()  # in `read_on`
        self.heard = 0
        self._lines: deque[bytes] = deque()
        self._rest = bytearray()
        self._stderr = StandardError(echo)
        self._output_ended = False
        self.input_closed = False  # by the program or by us
        self._ended = False

    @property
    def process(self) -> int:
        """The number of its process."""
        return self._process.pid

    # ------------------------------------------------------------ lines

    def line(self, *, seconds: float = inf) -> bytes:
        """The next line; waits until it is complete.

        Args:
            seconds: how long to wait; time in which the program waits for a processor is not
                counted.
        Raises:
            Silent: no line came in this time.
            Ended: the output has ended (in the middle of a line, if `in_half_a_line`).
            TooLong: the line has more bytes than a message may have.
        """
        clock = None if seconds == inf or self._lines else self._stopwatch(seconds)
        while not self._lines:
            if self._output_ended:
                raise Ended
            if clock is not None and clock.seconds() > seconds:
                raise Silent
            # Look at the exit status only after a silent tick: what it wrote last comes first.
            if not self._listen() and self._status() is not None:
                self._output_ended = True  # though its child may hold the stream open
        return self._lines.popleft()

    def write(self, data: bytes) -> None:
        """Send data. If the program has closed its input, drop them: its output may say why."""
        if self._head_sent:
            assert data.startswith(HEAD), "every message begins in the same way"
            data, self._head_sent = data[len(HEAD) :], False
        while data and not self.input_closed:
            try:
                data = data[os.write(self._in, data) :]
            except BlockingIOError:
                self._wait_for_room()
            except OSError:  # a broken pipe
                self.input_closed = True

    def close_input(self) -> None:
        """Close the program's standard input."""
        if not self.input_closed:
            self.input_closed = True
            assert self._process.stdin is not None
            self._process.stdin.close()

    @property
    def flooded_stderr(self) -> bool:
        """Whether it wrote more bytes on standard error than a message may have."""
        return self._stderr.bytes > LIMIT

    @property
    def in_half_a_line(self) -> bool:
        """Whether the last line that came lacks its line end."""
        return bool(self._rest)

    @property
    def has_line(self) -> bool:
        """Whether a line has come; reads without waiting."""
        if not self._lines and not self._output_ended:
            self._listen(0)
        return bool(self._lines)

    @property
    def unread(self) -> bytes:
        """The first line that came and was not asked for, perhaps incomplete."""
        return self._lines[0] if self._lines else bytes(self._rest)

    @property
    def has_output(self) -> bool:
        """Whether anything came that was not asked for; reads without waiting."""
        return self.has_line or bool(self._rest)

    def _stopwatch(self, seconds: float) -> Stopwatch:
        """A stopwatch of the seconds that the program uses from now on, while we wait for it.

        Args:
            seconds: how long we wait.
        """
        tick = max(TICK, seconds / 4)
        return Stopwatch(lambda: tasks_of(self.process), lambda: self.heard, tick=tick)

    def _listen(self, seconds: float = TICK) -> bool:
        """Read what has come, after waiting a tick at most; whether anything came."""
        looks = LOOKS if seconds and not self._processor.shared else 0
        # On one processor a look without waiting is in vain: the program runs when we sleep.
        ready = [] if seconds and not looks else self._poll.poll(0)
        while not ready and looks:
            began = monotonic()
            os.sched_yield()  # it may wait for this very processor
            # Others want the processor, too. A stopwatch excuses what we wait for it, so a program
            # that sleeps would have all the time in which we look again and again.
            looks = looks - 1 if monotonic() - began < BUSY else 0
            ready = self._poll.poll(0)
        if seconds and not ready:
            ready = self._poll.poll(int(1000 * seconds))
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
            self._output_ended = True
            self._poll.unregister(self._out)
            return
        self.heard += 1
        # `_rest` holds the bytes after the last line end. It is a bytearray because each chunk of a
        # long line would copy `bytes` whole.
        first, *more = chunk.split(b"\n")
        if self._rest or not more:
            self._rest += first
            if len(self._rest) > self._longest:
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
        self._stderr.take(chunk)

    def _wait_for_room(self) -> None:
        """Wait until the program reads, and read what it writes meanwhile, against a deadlock."""
        self._poll.register(self._in, select.POLLOUT)
        try:
            self._listen()
        finally:
            self._poll.unregister(self._in)
        self._require_room()

    def _require_room(self) -> None:
        if len(self._rest) + sum(map(len, self._lines)) > AHEAD * self._longest:
            raise TooLong

    def beside(self) -> None:
        """Keep a program with a single thread, and this thread, on one processor."""
        self._processor.follow()

    def apart(self) -> None:
        """Let this thread run again where it might before `beside`."""
        self._processor.release()

    def read_on(self) -> None:
        """Wait until the program reads our next message, of which it gets the first bytes now.

        A program that reads has written all that it had to write, and pipes keep the order: so
        what it wrote before has come when this returns. It returns, too, when its output has ended
        or no process can read our messages.

        Raises:
            TooLong: it writes and writes, and does not read.
        """
        self.write(HEAD)
        self._head_sent = True
        pause = 0.0
        while not (self.input_closed or self._output_ended or self._is_read()):
            sleep(pause)  # no event tells when a pipe is read; the program may need this processor
            pause = min(pause + PAUSE, 50 * PAUSE)
            if self._readers.poll(0):
                self.input_closed = True
            elif not self._listen(0):
                self._hear_of_end()
            self._require_room()
        while self._listen(0) and not self._output_ended:
            self._require_room()

    def _is_read(self) -> bool:
        """Whether the program has read all that was written to it."""
        try:
            return fcntl.ioctl(self._in, termios.FIONREAD, _NO_BYTES) == _NO_BYTES
        except OSError:  # a system that does not tell
            return True

    def _hear_of_end(self) -> None:
        if self._status() is not None:
            self._output_ended = True  # though its child may hold the stream open

    # ------------------------------------------------------------ its end

    def exit_status(self) -> str | None:
        """The exit status in words; None if the program still runs after `LAST_WORDS` seconds."""
        # Not by the wall clock: on a busy machine a program that dies waits for a processor, too.
        # It answers no more: each wait is excused.
        clock = Stopwatch(lambda: tasks_of(self.process), tick=LAST_WORDS / 4)
        while (status := self._status()) is None:
            if clock.seconds() > LAST_WORDS:
                return None
            self._listen(0)
            sleep(0.001)
        return str(status)

    def signal(self) -> str | None:
        """The name of the signal that ended the program, as SIGSEGV; None: none did."""
        status = self._status()
        return None if status is None else status.signal

    def ended_by_itself(self) -> bool | None:
        """Whether it ended in another way than with exit code 0; None: it can still play."""
        if not (self.input_closed or self._output_ended):
            return None
        return self.exit_status() not in (None, "ended with exit code 0")

    def stderr(self) -> str:
        """The tail of its standard error."""
        with suppress(OSError, KeyError):  # KeyError: the stream has ended and is no longer polled
            while any(stream == self._err for stream, _ in self._poll.poll(0)):
                self._drain()
        return self._stderr.tail

    def _status(self) -> ExitStatus | None:
        return exit_status(self._process.pid)

    def end(self, *, politely: float = 0.0) -> None:
        """End the program and all of its descendants: first SIGTERM, then SIGKILL.

        Args:
            politely: seconds to wait for its own end before SIGTERM.
        """
        if self._ended:
            return
        self._await_end(politely)
        if self._status() is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGTERM)
            self._await_end(GRACE)
        # The group still exists: its leader is not reaped before `wait` below, so no other process
        # can have its number.
        reaper.end_all(self._process.pid, self.mark)
        self._process.wait()
        self.stderr()  # the last of what it printed
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        self._reaper.ended(self._process.pid, self.mark)
        self._ended = True

    def _await_end(self, seconds: float) -> None:
        until = monotonic() + seconds
        while self._status() is None and monotonic() < until:
            sleep(0.002)


# ---------------------------------------------------------------- the reaper


class ReaperProcess:
    """The process of reaper.py; one serves any number of programs. Lives until `close`."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(  # noqa: S603  our own file
            [sys.executable, "-I", "-S", str(Path(reaper.__file__))],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            bufsize=0,
        )

    def started(self, group: int, mark: str) -> None:
        """Put a program on the list of those to kill."""
        self._write(f"+ {group} {mark}\n")

    def ended(self, group: int, mark: str) -> None:
        """Take a program off the list."""
        self._write(f"- {group} {mark}\n")

    def _write(self, line: str) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(line.encode())

    def close(self) -> None:
        """End the reaper, which first kills every program that is still on its list."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        self._process.wait()
