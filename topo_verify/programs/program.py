"""A program behind protocol 1 as a mapper: a callable that takes a robot, as any other.

    with Program("./mapper --fast") as program:
        report = examine(program.target, world)

The program receives percepts and answers with doors; the simulated robot checks and counts every
move. One process plays many worlds. If the program misbehaves, or a limit stops it, its process and
all descendants are ended, and the next world starts a fresh one.

Source: docs/semantics.md, section 15.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, ClassVar, Literal, Self

import msgspec

from topo_verify.errors import InputError, shown
from topo_verify.programs import isolation
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import GRACE, Child, Ended, ReaperProcess, TooLong
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import (
    Misbehaved,
    crash_report,
    decoded,
    seen,
    silence_report,
)
from topo_verify.robot.events import Finish, Robot
from topo_verify.robot.limits import BudgetExceeded, TimeLimitExceeded, helped_by
from topo_verify.robot.simulator import Misuse, SimulatedRobot

IN_A_ROW = 100_000
"""Most decisions that a program may declare without a move between them."""

DECLARED, DECLARED_EACH = 2**24, 2**8
"""Most bytes that a program may declare in a world; more for each pair of darts, a hypothesis."""

PREFIX = "--cmd "
"""The beginning of a TARGET that is a program."""

OPTIONS = (PREFIX, LIBRARY)


TranscriptLine = tuple[Literal[">", "<"], bytes]
"""A line to (`>`) or from (`<`) the program."""


class Program:
    """A program as a mapper; its first world starts the process.

    Args:
        command: the program and its arguments, split as a shell would; no shell runs.
        validate: refuse unknown and doubled fields, which the protocol ignores.
        record: keep the transcript of the last world in `lines`.
    Attributes:
        misbehaved: why the last world ended without a map, if the program is to blame.
    Raises:
        InputError: the command is empty or has an open quote; by a call: it cannot be started.
    """

    longest: ClassVar[int] = ms.LIMIT
    """The most bytes of a message from the program."""

    advice: ClassVar[str] = "; gdb names the line: docs/tutorials/any-language.md"
    """The end of the message of a crash."""

    def __init__(
        self, command: str | Sequence[str], *, validate: bool = False, record: bool = False
    ) -> None:
        isolation.shield()
        self._child: Child | None = None
        self._reaper: ReaperProcess | None = None
        self._idle = True  # the process waits for a world; False while it plays
        self._halted = False
        self.misbehaved: Misbehaved | None = None
        self.lines: list[TranscriptLine] = []
        self.validate, self.record = validate, record
        self._decode: Callable[[bytes], Any] = _from_program.decode
        self.command = split(command) if isinstance(command, str) else tuple(command)

    @property
    def target(self) -> Target:
        """The program with its TARGET."""
        return Target(PREFIX + shlex.join(self.command), self)

    def __call__(self, robot: Robot) -> Finish:
        """Play one world; return the program's map, as the event that ends the trace.

        Raises:
            MapperStopped: the program misbehaved, or a limit struck.
        """
        self.settle()
        self.misbehaved, self.lines = None, []
        try:
            child = self._ready()
        except Misbehaved as why:
            self.misbehaved = why.copy()
            raise
        self._idle = self._halted = False
        child.processor.follow()
        result: Finish | Misbehaved | None = None
        try:
            with helped_by(child.process, lambda: child.heard):
                result = self._play(child, robot)
                self._await_next(child)
        except Misbehaved as why:
            # A copy: the traceback of `why` refers to this frame, and a program in a circle of
            # references is not ended when its last user drops it.
            self.misbehaved = why.copy()
            raise
        except BudgetExceeded:
            self._halted = True
            raise
        except Misuse as why:
            self.misbehaved = Misbehaved("bad-door", str(why))
            raise
        except TimeLimitExceeded as why:
            # A failure reported in time counts even if the program does not read on.
            if not isinstance(result, Misbehaved) or result.kind in ("skip", "error"):
                self.misbehaved = silence_report(child, str(why), over=result is not None)
                raise
        if isinstance(result, Misbehaved):
            self.misbehaved = result
            raise result.copy()
        return result

    # ------------------------------------------------------------ a world

    def _play(self, child: Child, robot: Robot) -> Finish | Misbehaved:
        self._send(child, ms.StartMessage(percept=robot.percept))
        # Decisions cost no move of the budget; a flood would fill the memory before a time limit.
        declared, written, most = 0, 0, _most_declared(robot)
        decode = self._decode
        declare = robot.events.append if isinstance(robot, SimulatedRobot) else robot.declare
        while True:
            line = self._receive(child)
            try:
                message = decode(line)
            except Exception:  # noqa: BLE001  `decoded` says what is wrong
                message = None
            if message is None or self.validate:
                message = decoded(line, decode, validate=self.validate)
            if isinstance(message, ms.MoveMessage):
                percept = robot.move(message.door, message.purpose)
                declared = 0
                self._send(child, ms.PerceptMessage(percept.degree, percept.marker))
            elif isinstance(message, ms.DeclareMessage):
                declared, written = declared + 1, written + len(line)
                if declared > IN_A_ROW or written > most:
                    raise _too_many(declared, most)
                declare(message.event)
            elif isinstance(message, ms.DoneMessage):
                return Finish(message.cost, message.map)
            else:
                return _declined(message)

    def _await_next(self, child: Child) -> None:
        """Wait until the program reads on or ends: its output until then belongs to this world."""
        try:
            child.read_on()
        except TooLong:
            raise Misbehaved("too-long", self._too_long(child)) from None
        if child.has_output:
            words = f"the program went on after the world's end{seen(child)}"
            raise Misbehaved("out-of-turn", words)
        if (ended := child.ended_by_itself()) is None:
            self._idle = True
        elif ended:
            raise self._report_crash(child, "read the next message")

    def _send(self, child: Child, message: ms.ToChild) -> None:
        line = _encode(message)
        if self.validate:
            _to_program.decode(line)  # our own message must meet the schema; a failure is our bug
        if self.record:
            self.lines.append((">", line))
        try:
            child.write(line + b"\n")
        except TooLong:
            raise Misbehaved("too-long", self._too_long(child)) from None

    def _receive(self, child: Child) -> bytes:
        try:
            line = child.line()
        except TooLong:
            raise Misbehaved("too-long", self._too_long(child)) from None
        except Ended:
            raise self._report_crash(child, "delivered a map") from None
        if self.record:
            self.lines.append(("<", line))
        return line

    def _report_crash(self, child: Child, due: str) -> Misbehaved:
        return crash_report(child, due, self.advice)

    def _too_long(self, child: Child) -> str:
        if child.in_half_a_line:
            return f"the program wrote a line of more than {self.longest} bytes"
        return f"the program wrote more than {4 * self.longest} bytes and did not read the answers"

    # ------------------------------------------------------------ its process

    def start(self) -> None:
        """Start the process now instead of in its first world.

        Raises:
            InputError: the program cannot be started.
        """
        with suppress(Misbehaved):  # it was started before; the world in which it fails says so
            self._ready()

    def line(self) -> str:
        """The user's file and line at which a time limit stopped it, or "" if nothing tells."""
        return ""

    @property
    def process(self) -> int | None:
        """The process id, or None."""
        return None if self._child is None else self._child.process

    def _ready(self) -> Child:
        if self._child is None:
            self._reaper = self._reaper or ReaperProcess()
            try:
                self._child = self._started(self._reaper)
            except Exception:
                reaper, self._reaper = self._reaper, None
                reaper.close()
                raise
        return self._child

    def _started(self, reaper: ReaperProcess) -> Child:
        return Child(self.command, reaper)

    def settle(self) -> None:
        """End the process if it misbehaved in its last world. Call this outside of time limits."""
        if self._child is not None:
            self._child.processor.release()
            if not self._idle and not (self._halted and self._unwound()):
                self._child.end()
                self._child = None
        self._idle = True

    def _unwound(self) -> bool:
        return False

    def close(self) -> None:
        """Send `stop`, then end a process that does not obey."""
        self.settle()
        if self._child is not None:
            try:
                self._child.write(_encode(ms.StopMessage()) + b"\n")
                self._child.close_input()
            except TooLong:
                pass
            self._child.end(politely=GRACE)
            self._child = None
        if self._reaper is not None:
            self._reaper.close()
            self._reaper = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()


# ---------------------------------------------------------------- commands


def split(command: str) -> tuple[str, ...]:
    """The words of a command line, split as a shell would.

    Raises:
        InputError: there is no word, or a quote is open.
    """
    try:
        words = tuple(shlex.split(command))
    except ValueError as error:
        raise InputError(f"--cmd {command!r}: {error}; quote as for a shell") from None
    if not words:
        raise InputError("--cmd: name a program, as in --cmd './mapper --fast'")
    return words


# ---------------------------------------------------------------- lines

_encode = msgspec.json.Encoder().encode
_to_program: msgspec.json.Decoder[ms.ToProgram] = msgspec.json.Decoder(ms.ToProgram)
_from_program: msgspec.json.Decoder[ms.FromProgram] = msgspec.json.Decoder(ms.FromProgram)


def _declined(message: ms.SkipMessage | ms.ErrorMessage | ms.UndeliveredMessage) -> Misbehaved:
    if isinstance(message, ms.UndeliveredMessage):
        return Misbehaved(message.kind, message.why)
    skips = isinstance(message, ms.SkipMessage)
    verb = "skips this world" if skips else "gives this world up"
    why = f": {shown(message.why)}" if message.why else ", and does not say why"
    return Misbehaved("skip" if skips else "error", f"the program {verb}{why}")


def _most_declared(robot: Robot) -> int:
    darts = robot.darts if isinstance(robot, SimulatedRobot) else 0
    return DECLARED + DECLARED_EACH * darts**2


def _too_many(declared: int, most: int) -> Misbehaved:
    words = f"{declared} decisions without a move between them"
    if declared <= IN_A_ROW:
        words = f"decisions of more than {most} bytes in this world"
    return Misbehaved("declarations", f"the program declared {words}")
