"""A program as a child process: lines to it, lines from it, and its end.

The program may flood a stream, stop reading, ignore signals, or start children. Still the kept
output is bounded, nothing blocks for longer than a tick, and `end` leaves no process behind.

A move is three system calls: write, poll, read. On one processor (process.py) a poll sleeps at
once. Otherwise an idle processor takes tens of microseconds to wake up, so a poll looks some
hundred times before it sleeps.
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
from topo_verify.programs.process import (
    SUCCESS,
    ExitStatus,
    SharedProcessor,
    StandardError,
    exit_status,
)
from topo_verify.programs.protocol import LIMIT
from topo_verify.robot.limits import TICK
from topo_verify.robot.stopwatch import Stopwatch, tasks_of

GRACE = 0.3
"""Seconds between SIGTERM and SIGKILL, or between a `stop` message and SIGTERM."""

LAST_WORDS = 2.0
"""Most seconds between the end of a program's output and its exit status."""

CHUNK = 2**16

HEAD = b'{"type":"'
"""The first bytes of every message to a program."""

AHEAD = 4
"""Unread output may hold `AHEAD` messages of maximal length."""

PAUSE = 2e-5
"""Seconds by which pauses grow while a program does not read."""

_NO_BYTES = bytes(4)

LOOKS = 200
"""Polls without waiting before a poll that sleeps, if the program has another processor."""

BUSY = 5e-4
"""Most seconds that a look takes on a processor without other work."""


class Ended(Exception):
    """The program's output has ended."""


class Silent(Exception):
    """No line came in time."""


class TooLong(Exception):
    """A line is too long, or the program writes many lines and reads none."""


class Child:
    """A program that runs as a child process.

    Args:
        command: the program and its arguments; no shell expands them.
        longest: the most bytes of a line.
        echo: copy its standard error to ours, each line behind this mark.
    Attributes:
        heard: how often its output was read.
        processor: follow it before a world, release it after.
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
        self._readers = select.poll()
        self._readers.register(self._in, 0)
        self._head_sent = False
        self.processor = SharedProcessor(self._process.pid)
        sleep_briefly()
        self.heard = 0
        self._lines: deque[bytes] = deque()
        self._rest = bytearray()
        self._stderr = StandardError(echo)
        self._output_ended = False
        self.input_closed = False
        self._ended = False
        self._reaped = False

    @property
    def process(self) -> int:
        """The id of its process."""
        return self._process.pid

    # ------------------------------------------------------------ lines

    def line(self, *, seconds: float = inf) -> bytes:
        """Wait for the next line, without its line end.

        Args:
            seconds: how long, not counting the program's waits for a processor.
        Raises:
            Silent: no line came in this time.
            Ended: the output has ended.
            TooLong: the line is too long.
        """
        clock = None if seconds == inf or self._lines else self._stopwatch(seconds)
        while not self._lines:
            if self._output_ended:
                raise Ended
            if clock is not None and clock.seconds() > seconds:
                raise Silent
            # Its last output comes first, so ask for the exit status only after a silent tick.
            if not self._listen():
                self._hear_of_end()
        return self._lines.popleft()

    def write(self, data: bytes) -> None:
        """Send data, or drop them if the program has closed its input: its output may say why."""
        if self._head_sent:
            assert data.startswith(HEAD), "every message begins in the same way"
            data, self._head_sent = data[len(HEAD) :], False
        while data and not self.input_closed:
            try:
                data = data[os.write(self._in, data) :]
            except BlockingIOError:
                self._wait_for_room()
            except OSError:
                self.input_closed = True

    def close_input(self) -> None:
        """Close the program's standard input."""
        if not self.input_closed:
            self.input_closed = True
            assert self._process.stdin is not None
            self._process.stdin.close()

    @property
    def flooded_stderr(self) -> bool:
        """Did it write more than a message may have on standard error?"""
        return self._stderr.bytes > LIMIT

    @property
    def in_half_a_line(self) -> bool:
        """Does the last line lack its line end?"""
        return bool(self._rest)

    @property
    def has_line(self) -> bool:
        """Has a line come? Reads without waiting."""
        if not self._lines and not self._output_ended:
            self._listen(0)
        return bool(self._lines)

    @property
    def unread(self) -> bytes:
        """The first line not yet taken, perhaps incomplete."""
        return self._lines[0] if self._lines else bytes(self._rest)

    @property
    def has_output(self) -> bool:
        """Does output wait to be taken? Reads without waiting."""
        return self.has_line or bool(self._rest)

    def _stopwatch(self, seconds: float) -> Stopwatch:
        tick = max(TICK, seconds / 4)
        return Stopwatch(lambda: tasks_of(self.process), lambda: self.heard, tick=tick)

    def _listen(self, seconds: float = TICK) -> bool:
        """Read what has come, after waiting a tick at most; True if anything came."""
        looks = LOOKS if seconds and not self.processor.shared else 0
        # On one processor the program runs only when we sleep.
        ready = [] if seconds and not looks else self._poll.poll(0)
        while not ready and looks:
            began = monotonic()
            os.sched_yield()
            # If others want the processor, stop looking: a stopwatch excuses such waits, so a
            # sleeping program would have all that time.
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
        # A bytearray, since `bytes` would be copied for each chunk of a long line.
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
        self._poll.register(self._in, select.POLLOUT)
        try:
            self._listen()
        finally:
            self._poll.unregister(self._in)
        self._require_room()

    def _require_room(self) -> None:
        if len(self._rest) + sum(map(len, self._lines)) > AHEAD * self._longest:
            raise TooLong

    def read_on(self) -> None:
        """Wait until the program reads our next message, whose first bytes are sent now.

        Before it reads, it has written its output, and pipes keep the order. Returns also when its
        output has ended or no process reads our messages.

        Raises:
            TooLong: it writes on and on, and does not read.
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
        try:
            return fcntl.ioctl(self._in, termios.FIONREAD, _NO_BYTES) == _NO_BYTES
        except OSError:
            return True

    def _hear_of_end(self) -> None:
        if self._status() is not None:
            self._output_ended = True  # though its child may hold the stream open

    # ------------------------------------------------------------ its end

    def exit_status(self) -> ExitStatus | None:
        """The exit status; None if the program still runs after `LAST_WORDS` seconds."""
        # Not by the wall clock: on a busy machine a dying program waits for a processor, too.
        clock = Stopwatch(lambda: tasks_of(self.process), tick=LAST_WORDS / 4)
        while (status := self._status()) is None:
            if clock.seconds() > LAST_WORDS:
                return None
            self._listen(0)
            sleep(0.001)
        return status

    def after_signal(self, number: int, seconds: float) -> bytes:
        """What it writes after this signal, within some seconds or until a silent tick."""
        with suppress(ProcessLookupError, PermissionError):
            os.kill(self._process.pid, number)
        until = monotonic() + seconds
        written = b""
        with suppress(TooLong):
            while monotonic() < until and not self._output_ended:
                heard = self._listen()
                written = b"\n".join((*self._lines, self._rest))
                if written and not heard:
                    break
        return written

    def signal(self) -> str | None:
        """The name of the signal that ended the program, or None."""
        status = self._status()
        return None if status is None else status.signal

    def ended_by_itself(self) -> bool | None:
        """Did it fail, with another exit code than 0? None: it can still play."""
        if not (self.input_closed or self._output_ended):
            return None
        return self.exit_status() not in (None, SUCCESS)

    def stderr(self) -> str:
        """The end of its standard error."""
        with suppress(OSError, KeyError):  # KeyError: the stream has ended and is no longer polled
            while any(stream == self._err for stream, _ in self._poll.poll(0)):
                self._drain()
        return self._stderr.tail

    def _status(self) -> ExitStatus | None:
        try:
            return exit_status(self._process.pid)
        except ChildProcessError:
            # It was reaped: by `Popen.__del__`, which the garbage collector may call before that of
            # our user, or by a caller that waits for all of its children.
            self._reaped = True
            code = self._process.returncode or 0
            return ExitStatus(os.CLD_KILLED if code < 0 else os.CLD_EXITED, abs(code))

    def end(self, *, politely: float = 0.0) -> None:
        """End the program and its descendants: SIGTERM, then SIGKILL.

        Args:
            politely: seconds to wait before SIGTERM.
        """
        if self._ended:
            return
        self._await_end(politely)
        if self._status() is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGTERM)
            self._await_end(GRACE)
        # The leader is reaped only by `wait` below, so the group still has its number. If it was
        # reaped elsewhere, the number may be that of another group.
        self._status()
        reaper.end_all(None if self._reaped else self._process.pid, self.mark)
        self._process.wait()
        self.stderr()
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
    """The process of reaper.py, for any number of programs."""

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
        """Add a program to the list of those to kill."""
        self._write(f"+ {group} {mark}\n")

    def ended(self, group: int, mark: str) -> None:
        """Take a program off the list."""
        self._write(f"- {group} {mark}\n")

    def _write(self, line: str) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(line.encode())

    def close(self) -> None:
        """End the reaper, which kills every program on its list."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        self._process.wait()
