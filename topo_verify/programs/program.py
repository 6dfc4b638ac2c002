"""A program behind protocol 1 as a mapper: call it with a robot, as any other.

    with Program("./mapper --fast") as program:
        report = examine(program.target, world)

The program sees percepts and answers doors; it never sees the world and cannot cheat, and every
move is made, checked and counted by the simulated robot. One process plays many worlds. After a
world in which it misbehaved, or was stopped, it is ended with everything it has started, and a
fresh one is started for the next.

Limits of moves and time are those of `explore`, which strike here as they do in Python: nothing
below waits longer than a tick. Life cycle: made (nothing runs yet), called any number of times,
`settle` after a world to end a process that misbehaved, `close` at the end.

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
from topo_verify.programs.child import GRACE, Child, Ended, TooLong, Warden
from topo_verify.programs.loading import Target
from topo_verify.robot.events import MapData
from topo_verify.robot.limits import MapperStopped, TimeLimitExceeded, helped_by
from topo_verify.robot.simulator import Misuse, SimulatedRobot
from topo_verify.text import shown

Kind = Literal[
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
"""What a program may do instead of delivering a map; docs/oracle.md has each with its cure."""

KINDS: tuple[Kind, ...] = get_args(Kind)

IN_A_ROW = 100_000
"""So many decisions may be declared without a move between them."""

SHOWN = 120
"""So much of a bad line is shown."""

PREFIX = "--cmd "
"""How the text of a TARGET begins that is a program."""


class Misbehaved(MapperStopped):
    """The program delivers no map in this world.

    Attributes:
        kind: what it did instead.
        detail: what is known beyond the sentence that says why it was stopped.
    """

    def __init__(self, kind: Kind, told: str, *, detail: str = "") -> None:
        super().__init__(told)
        self.kind: Kind = kind
        self.detail = detail


class Survey(NamedTuple):
    """What a program delivers."""

    vertices: Sequence[Sequence[int]]
    edges: Sequence[Sequence[int]]
    marker: int | None
    cost: int | None


Line = tuple[Literal[">", "<"], bytes]
"""A line of a transcript: to the program, from the program."""


class Program:
    """A program as a mapper; see above.

    Args:
        command: the program and its arguments, as a shell would split them; no shell is run.
        validate: refuse what the protocol passes over: fields that it does not know, or twice.
        record: keep the lines of the world that was played last, in `lines`.
    Attributes:
        misbehaved: why the last world ended without a map, if the program is to blame.
        lines: the transcript of the last world.
    Raises:
        InputError: the command is empty or has an open quote; when called: it cannot be started.
    """

    def __init__(
        self, command: str | Sequence[str], *, validate: bool = False, record: bool = False
    ) -> None:
        self._child: Child | None = None
        self._warden: Warden | None = None
        self._idle = True  # nothing is amiss with the process, it waits for a world
        self.misbehaved: Misbehaved | None = None
        self.lines: list[Line] = []
        self.validate, self.record = validate, record
        self.command = split(command) if isinstance(command, str) else tuple(command)

    @property
    def target(self) -> Target:
        """The program as the command line names it."""
        return Target(PREFIX + shlex.join(self.command), self)

    def __call__(self, robot: SimulatedRobot) -> Survey:
        """Play one world."""
        self.settle()
        self.misbehaved, self.lines = None, []
        child = self._ready()
        self._idle = False
        try:
            with helped_by(child.process):
                found = self._play(child, robot)
        except Misbehaved as why:
            # A copy: what is raised holds on to this frame, and so to the program.
            self.misbehaved = Misbehaved(why.kind, str(why), detail=why.detail)
            self._idle = why.kind in ("skip", "error")
            raise
        except Misuse as why:
            self.misbehaved = Misbehaved("bad-door", str(why))
            raise
        except TimeLimitExceeded as why:
            self.misbehaved = _silence(child, str(why))
            raise
        self._idle = True
        return found

    # ------------------------------------------------------------ a world

    def _play(self, child: Child, robot: SimulatedRobot) -> Survey:
        if child.speaks:
            raise Misbehaved(
                "out-of-turn", f"the program wrote before the world began{_seen(child)}"
            )
        self._send(child, ms.Start(percept=robot.percept))
        declared = 0
        while True:
            message = self._receive(child)
            if isinstance(message, ms.Move):
                percept = robot.move(message.door)
                declared = 0
                self._send(child, ms.Sensed(percept.degree, percept.marker))
            elif isinstance(message, ms.Declare):
                declared += 1
                if declared > IN_A_ROW:
                    told = f"the program declared {declared} decisions without a move between them"
                    raise Misbehaved("declarations", told)
                robot.declare(message.event)
            elif isinstance(message, ms.Done):
                self._require_silence(child)
                return _survey(message.map, message.cost)
            else:
                self._require_silence(child)
                kind: Kind = "skip" if isinstance(message, ms.Skip) else "error"
                verb = "skips this world" if kind == "skip" else "gives this world up"
                why = f": {shown(message.why)}" if message.why else ", and does not say why"
                raise Misbehaved(kind, f"the program {verb}{why}")

    def _require_silence(self, child: Child) -> None:
        if child.half or child.pending:
            raise Misbehaved(
                "out-of-turn", f"the program went on after the world's end{_seen(child)}"
            )

    def _send(self, child: Child, message: ms.ToProgram) -> None:
        line = _encode(message)
        if self.validate:
            _to_program.decode(line)  # ours must keep to the schema, too: if not, it is our bug
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
            raise obituary(child, "delivered a map") from None
        if self.record:
            self.lines.append(("<", line))
        message: ms.FromProgram = decoded(line, _from_program.decode, validate=self.validate)
        return message

    # ------------------------------------------------------------ its process

    def start(self) -> None:
        """Start it now, and not in its first world.

        Raises:
            InputError: it cannot be started.
        """
        self._ready()

    def _ready(self) -> Child:
        """A process that waits for a world."""
        if self._child is None:
            self._warden = self._warden or Warden()
            self._child = Child(self.command, self._warden)
        return self._child

    def settle(self) -> None:
        """End the process if its last world did not end as it should. Call it outside of limits."""
        if self._child is not None and not self._idle:
            self._child.end()
            self._child = None
        self._idle = True

    def close(self) -> None:
        """Tell the process to stop, and see to it that it does."""
        self.settle()
        if self._child is not None:
            try:
                self._child.write(_encode(ms.Stop()) + b"\n")
                self._child.close_input()
            except TooLong:
                pass  # it will be told otherwise
            self._child.end(politely=GRACE)
            self._child = None
        if self._warden is not None:
            self._warden.close()
            self._warden = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()


# ---------------------------------------------------------------- commands


def split(command: str) -> tuple[str, ...]:
    """A command line in words, split as a shell would.

    Raises:
        InputError: there is no word in it, or a quote is open.
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
_TOO_FAR_AHEAD = "the program wrote on and on and did not read what it was answered"


def decoded(line: bytes, decode: Callable[[bytes], Any], *, validate: bool) -> Any:
    """The message in a line from a program.

    Raises:
        Misbehaved: it is no message; the sentence shows the line.
    """
    try:
        message = decode(line)
        if validate:
            _require_schema(line, message)
    except RecursionError:
        told = f"the program wrote a line that is nested too deeply: {shown_line(line)}"
        raise Misbehaved("nested", told) from None
    except UnicodeDecodeError:
        raise Misbehaved("not-utf8", f"the program wrote no UTF-8: {shown_line(line)}") from None
    except msgspec.ValidationError as error:
        kind = _kind(str(error))
        told = f"the program wrote no message of the protocol: {error}: {shown_line(line)}"
        raise Misbehaved(kind, told) from None
    except msgspec.DecodeError as error:
        told = str(error).removeprefix("JSON is malformed: ")
        told = f"the program wrote what is no JSON ({told}): {shown_line(line)}"
        raise Misbehaved("not-json", told) from None
    return message


def _kind(error: str) -> Kind:
    if error.endswith("`$.type`"):
        return "unknown-type"
    return "bad-declaration" if "`$.event" in error or "`$.declare" in error else "malformed"


def _require_schema(line: bytes, message: object) -> None:
    """Are all its fields in the schema, and none there twice?"""

    def single(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        data = dict(pairs)
        if len(data) < len(pairs):
            told = f"the program wrote a field twice (--validate): {shown_line(line)}"
            raise Misbehaved("doubled-field", told)
        return data

    data = json.loads(line, object_pairs_hook=single)
    for place in ms.strangers(data, message):
        told = f"the program wrote {place}, which the schema does not list (--validate)"
        raise Misbehaved("unknown-field", f"{told}: {shown_line(line)}")


def shown_line(line: bytes) -> str:
    """A line fit to be shown."""
    return shown(line[: 2 * SHOWN].decode(errors="backslashreplace"), limit=SHOWN)


def obituary(child: Child, due: str) -> Misbehaved:
    """Why there is no next line, although the program has not yet done what was due."""
    fate = child.fate()
    words = last_words(child.stderr())
    if child.half:
        end = fate or "closed its output"
        return Misbehaved("half-line", f"the program {end} in the middle of a line{words}")
    if fate is None:
        return Misbehaved("closed-output", "the program closed its output and runs on")
    return Misbehaved("crashed", f"the program {fate} before it {due}{words}")


def _silence(child: Child, told: str) -> Misbehaved | None:
    """What is known of a program that was stopped for its silence, beyond that."""
    if child.half:
        return Misbehaved("half-line", told, detail=f", in the middle of a line{_seen(child)}")
    if child.deaf:
        return Misbehaved("closed-input", told, detail="; it has closed its input")
    if child.flooded:
        detail = f"; it wrote more than {ms.LIMIT} bytes on standard error"
        return Misbehaved("flooded-stderr", told, detail=detail)
    return None


def last_words(stderr: str) -> str:
    """The last line on standard error, to be put behind a sentence."""
    lines = [line for line in stderr.splitlines() if line.strip()]
    return f"; its last words: {shown(lines[-1].strip())}" if lines else ""


def _seen(child: Child) -> str:
    return f": {shown_line(child.pending)}" if child.pending else ""


def _survey(found: MapData, cost: int | None) -> Survey:
    return Survey(found.vertices, found.edges, found.marker, cost)
