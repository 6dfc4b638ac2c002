"""A program behind protocol 1 as a mapper: a callable that takes a robot, as any other.

    with Program("./mapper --fast") as program:
        report = examine(program.target, world)

The program receives percepts and answers with doors. It never receives the world, so it cannot
cheat; the simulated robot makes, checks and counts every move. One process plays many worlds. If
the program misbehaves in a world, or a limit stops it, its process and all descendants are ended,
and the next world starts a fresh one.

The limits of moves and time are those of `explore`. They strike here as they do in Python, because
nothing below blocks for longer than a tick.

Life cycle: construction (starts nothing); any number of calls; after a call, `settle` ends a
process that misbehaved; at last `close`.

Source: docs/semantics.md, section 15.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple, Self, get_args

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import AHEAD, GRACE, Child, Ended, ReaperProcess, TooLong
from topo_verify.programs.loader import Target
from topo_verify.robot.events import MapData
from topo_verify.robot.limits import MapperStopped, TimeLimitExceeded, helped_by
from topo_verify.robot.simulator import Misuse, SimulatedRobot
from topo_verify.text import shown

Misbehaviour = Literal[
    "crashed",
    "closed-output",
    "closed-input",
    "flooded-stderr",
    "half-line",
    "too-long",
    "not-json",
    "not-utf8",
    "nested",
    "unknown-type",
    "malformed",
    "bad-declaration",
    "unknown-field",
    "doubled-field",
    "out-of-turn",
    "declarations",
    "bad-door",
    "silent",
    "unknown-world",
    "skip",
    "error",
]
"""What a program may do instead of delivering a map. Docs/oracle.md lists causes and cures."""

MISBEHAVIOURS: tuple[Misbehaviour, ...] = get_args(Misbehaviour)

IN_A_ROW = 100_000
"""The most decisions that a program may declare without a move between them."""

SHOWN = 120
"""How many characters of a bad line a message shows."""

PREFIX = "--cmd "
"""The beginning of a TARGET that is a program."""


class Misbehaved(MapperStopped):
    """The program delivers no map in this world.

    Attributes:
        kind: what it did instead.
        detail: words to append to the sentence that says why it was stopped.
        signal: the name of the signal that ended it, as SIGSEGV; None: none did.
    """

    def __init__(
        self, kind: Misbehaviour, message: str, *, detail: str = "", signal: str | None = None
    ) -> None:
        super().__init__(message)
        self.kind: Misbehaviour = kind
        self.detail = detail
        self.signal = signal


class DeliveredMap(NamedTuple):
    """The map that a program delivers, as `explore` reads the result of any mapper."""

    vertices: Sequence[Sequence[int]]
    edges: Sequence[Sequence[int]]
    marker: int | None
    cost: int | None


TranscriptLine = tuple[Literal[">", "<"], bytes]
"""A line of a transcript: `>` to the program, `<` from the program."""


class Program:
    """A program as a mapper; the module's docstring says how.

    Args:
        command: the program and its arguments, split as a shell would; no shell runs.
        validate: refuse unknown and doubled fields, which the protocol ignores.
        record: keep the transcript of the last world in `lines`.
    Attributes:
        misbehaved: why the last world ended without a map, if the program is to blame.
        lines: the transcript of the last world.
    Raises:
        InputError: the command is empty or has an open quote; by a call: it cannot be started.
    """

    def __init__(
        self, command: str | Sequence[str], *, validate: bool = False, record: bool = False
    ) -> None:
        self._child: Child | None = None
        self._reaper: ReaperProcess | None = None
        self._idle = True  # the process waits for a world; False while it plays
        self.misbehaved: Misbehaved | None = None
        self.lines: list[TranscriptLine] = []
        self.validate, self.record = validate, record
        self.command = split(command) if isinstance(command, str) else tuple(command)

    @property
    def target(self) -> Target:
        """The program with its TARGET."""
        return Target(PREFIX + shlex.join(self.command), self)

    def __call__(self, robot: SimulatedRobot) -> DeliveredMap:
        """Play one world with the program.

        Raises:
            MapperStopped: the program misbehaved, or a limit struck.
        """
        self.settle()
        self.misbehaved, self.lines = None, []
        child = self._ready()
        self._idle = False
        try:
            with helped_by(child.process):
                found = self._play(child, robot)
        except Misbehaved as why:
            # Keep a copy: the traceback of `why` refers to this frame and thus to the program, and
            # a program in a circle of references is not ended when its last user drops it.
            self.misbehaved = Misbehaved(why.kind, str(why), detail=why.detail, signal=why.signal)
            # These two end a world as the protocol says, so the process is fit for the next one.
            self._idle = why.kind in ("skip", "error")
            raise
        except Misuse as why:
            self.misbehaved = Misbehaved("bad-door", str(why))
            raise
        except TimeLimitExceeded as why:
            self.misbehaved = _silence_report(child, str(why))
            raise
        self._idle = True
        return found

    # ------------------------------------------------------------ a world

    def _play(self, child: Child, robot: SimulatedRobot) -> DeliveredMap:
        if child.has_output:
            raise Misbehaved(
                "out-of-turn", f"the program wrote before the world began{_seen(child)}"
            )
        self._send(child, ms.StartMessage(percept=robot.percept))
        # Decisions are counted because they cost no move of the budget, and a flood of them would
        # fill the memory before a time limit strikes.
        declared = 0
        while True:
            message = self._receive(child)
            if isinstance(message, ms.MoveMessage):
                percept = robot.move(message.door)
                declared = 0
                self._send(child, ms.PerceptMessage(percept.degree, percept.marker))
            elif isinstance(message, ms.DeclareMessage):
                declared += 1
                if declared > IN_A_ROW:
                    raise Misbehaved(
                        "declarations",
                        f"the program declared {declared} decisions without a move between them",
                    )
                robot.declare(message.event)
            elif isinstance(message, ms.DoneMessage):
                self._require_silence(child)
                return _delivered(message.map, message.cost)
            else:
                self._require_silence(child)
                kind: Misbehaviour = "skip" if isinstance(message, ms.SkipMessage) else "error"
                verb = "skips this world" if kind == "skip" else "gives this world up"
                why = f": {shown(message.why)}" if message.why else ", and does not say why"
                raise Misbehaved(kind, f"the program {verb}{why}")

    def _require_silence(self, child: Child) -> None:
        # Only what came in the same read: waiting for more would slow down every world. A later
        # line is found before the next world begins.
        if child.in_half_a_line or child.unread:
            raise Misbehaved(
                "out-of-turn", f"the program went on after the world's end{_seen(child)}"
            )

    def _send(self, child: Child, message: ms.ToProgram) -> None:
        line = _encode(message)
        if self.validate:
            _to_program.decode(line)  # our own message must meet the schema; a failure is our bug
        if self.record:
            self.lines.append((">", line))
        try:
            child.write(line + b"\n")
        except TooLong:
            raise Misbehaved("too-long", _TOO_FAR_AHEAD) from None

    def _receive(self, child: Child) -> ms.FromProgram:
        try:
            line = child.line()
        except TooLong:
            raise Misbehaved("too-long", _TOO_LONG) from None
        except Ended:
            raise crash_report(child, "delivered a map") from None
        if self.record:
            self.lines.append(("<", line))
        message: ms.FromProgram = decoded(line, _from_program.decode, validate=self.validate)
        return message

    # ------------------------------------------------------------ its process

    def start(self) -> None:
        """Start the process now instead of in its first world.

        Raises:
            InputError: the program cannot be started.
        """
        self._ready()

    def _ready(self) -> Child:
        """The process that waits for a world; started if there is none."""
        if self._child is None:
            self._reaper = self._reaper or ReaperProcess()
            self._child = Child(self.command, self._reaper)
        return self._child

    def settle(self) -> None:
        """End the process if it misbehaved in its last world. Call this outside of time limits."""
        if self._child is not None and not self._idle:
            self._child.end()
            self._child = None
        self._idle = True

    def close(self) -> None:
        """Send `stop`, then end a process that does not obey. A later call starts another one."""
        self.settle()
        if self._child is not None:
            try:
                self._child.write(_encode(ms.StopMessage()) + b"\n")
                self._child.close_input()
            except TooLong:
                pass  # `end` below stops it by a signal
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

_TOO_LONG = f"the program wrote a line of more than {ms.LIMIT} bytes"
_TOO_FAR_AHEAD = f"the program wrote more than {AHEAD} bytes and did not read the answers"


def decoded(line: bytes, decode: Callable[[bytes], Any], *, validate: bool) -> Any:
    """The message in a line from a program.

    Raises:
        Misbehaved: the line holds no message; the sentence shows the line.
    """
    kind: Misbehaviour
    try:
        message = decode(line)
        if validate:
            _require_schema(line, message)
    except RecursionError:
        kind, what = "nested", "a line that is nested too deeply"
    except UnicodeDecodeError:
        kind, what = "not-utf8", "a line that is not UTF-8"
    except msgspec.ValidationError as error:
        kind, what = _kind(str(error)), f"a line that is no message of the protocol: {error}"
    except msgspec.DecodeError as error:
        reason = str(error).removeprefix("JSON is malformed: ")
        kind, what = "not-json", f"a line that is not JSON ({reason})"
    else:
        return message
    raise Misbehaved(kind, f"the program wrote {what}: {shown_line(line)}")


def _kind(error: str) -> Misbehaviour:
    """The misbehaviour that a validation error stands for; msgspec says only at which path."""
    if error.endswith("`$.type`"):
        return "unknown-type"
    return "bad-declaration" if "`$.event" in error or "`$.declare" in error else "malformed"


def _require_schema(line: bytes, message: object) -> None:
    """Refuse a line with a field that the schema does not list, or with the same field twice."""

    def single(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        data = dict(pairs)
        if len(data) < len(pairs):
            message = f"the program wrote a field twice (--validate): {shown_line(line)}"
            raise Misbehaved("doubled-field", message)
        return data

    data = json.loads(line, object_pairs_hook=single)
    for place in ms.unknown_fields(data, message):
        what = f"{place}, which the schema does not list (--validate)"
        raise Misbehaved("unknown-field", f"the program wrote {what}: {shown_line(line)}")


def shown_line(line: bytes) -> str:
    """A line as printable text, cut to `SHOWN` characters."""
    return shown(line[: 2 * SHOWN].decode(errors="backslashreplace"), limit=SHOWN)


def crash_report(child: Child, due: str) -> Misbehaved:
    """Why a program's output ended too early.

    Args:
        due: what the program had yet to do, as in "delivered a map".
    """
    status = child.exit_status()
    complaint = last_stderr_line(child.stderr())
    if child.in_half_a_line:
        end = status or "closed its output"
        return Misbehaved("half-line", f"the program {end} in the middle of a line{complaint}")
    if status is None:
        return Misbehaved("closed-output", "the program closed its output and runs on")
    message = f"the program {status} before it {due}{complaint}"
    killed = status.removeprefix("was ended by ")
    return Misbehaved("crashed", message, signal=killed if killed != status else None)


def _silence_report(child: Child, message: str) -> Misbehaved | None:
    """The reason why a program that ran out of time was silent; None if none is known."""
    if child.in_half_a_line:
        return Misbehaved("half-line", message, detail=f", in the middle of a line{_seen(child)}")
    if child.input_closed:
        return Misbehaved("closed-input", message, detail="; it has closed its input")
    if child.flooded_stderr:
        detail = f"; it wrote more than {ms.LIMIT} bytes on standard error"
        return Misbehaved("flooded-stderr", message, detail=detail)
    return None


def last_stderr_line(stderr: str) -> str:
    """The last line on standard error, as words to append to a sentence."""
    lines = [line for line in stderr.splitlines() if line.strip()]
    return f"; its last line on standard error: {shown(lines[-1].strip())}" if lines else ""


def _seen(child: Child) -> str:
    return f": {shown_line(child.unread)}" if child.unread else ""


def _delivered(found: MapData, cost: int | None) -> DeliveredMap:
    return DeliveredMap(found.vertices, found.edges, found.marker, cost)
