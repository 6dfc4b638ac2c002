"""What a program does instead of delivering a map, and the sentence that says so.

docs/reference/programs.md lists causes and cures.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Literal, get_args

import msgspec

from topo_verify.errors import shown
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import Child
from topo_verify.programs.interruption import FROM_OUTSIDE
from topo_verify.robot.events import decode_error
from topo_verify.robot.limits import Limit, MapperStopped

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
    "not-reading",
    "declarations",
    "bad-door",
    "silent",
    "unknown-world",
    "no-map",
    "out-of-memory",
    "skip",
    "error",
]

RunEnd = Literal["map", "worker-lost"] | Limit | Misbehaviour
"""How a run ended: it delivered a map, lost its worker, met a limit, or the mapper did this."""

MISBEHAVIOURS: tuple[Misbehaviour, ...] = get_args(Misbehaviour)

SHOWN = 120
"""Characters of a bad line that a message shows."""

CRASHES = ("SIGSEGV", "SIGBUS", "SIGABRT", "SIGFPE")
"""Signals by which a fault in machine code ends its process."""

_OUTSIDE = {number.name for number in FROM_OUTSIDE}

PROGRAM = "the program"

LAST_LINES = 10
"""Last lines of standard error that a message shows."""


class Misbehaved(MapperStopped):
    """The program delivers no map in this world.

    Attributes:
        kind: what it did instead.
        detail: words to append to the message.
        signal: the signal that ended it, as SIGSEGV, or None.
    """

    def __init__(
        self, kind: Misbehaviour, message: str, *, detail: str = "", signal: str | None = None
    ) -> None:
        super().__init__(message)
        self.kind: Misbehaviour = kind
        self.detail = detail
        self.signal = signal

    @property
    def maybe_external(self) -> bool:
        """Whether something else may have ended the program, e.g. the out-of-memory killer."""
        return self.signal in _OUTSIDE

    def copy(self) -> Misbehaved:
        """The same without a traceback, which would keep the frames of the run alive."""
        return Misbehaved(self.kind, str(self), detail=self.detail, signal=self.signal)


def decoded(
    line: bytes, decode: Callable[[bytes], Any], *, validate: bool, who: str = PROGRAM
) -> Any:
    """The message in a line from a program; `who` is the subject of the sentence.

    Raises:
        Misbehaved: the line holds no message.
    """
    kind: Misbehaviour
    try:
        message = decode(line)
        if validate:
            _require_schema(line, message)
    except RecursionError:
        kind, description = "nested", "a line that is nested too deeply"
    except UnicodeDecodeError:
        kind, description = "not-utf8", "a line that is not UTF-8"
    except msgspec.ValidationError as error:
        kind = _kind(str(error))
        description = f"a line that is no message of the protocol: {decode_error(error)}"
    except msgspec.DecodeError as error:
        reason = str(error).removeprefix("JSON is malformed: ")
        kind, description = "not-json", f"a line that is not JSON ({reason})"
    else:
        return message
    raise Misbehaved(kind, f"{who} wrote {description}: {shown_line(line)}")


def _kind(error: str) -> Misbehaviour:
    if error.endswith("`$.type`"):
        return "unknown-type"
    return "bad-declaration" if "`$.event" in error or "`$.declare" in error else "malformed"


def _require_schema(line: bytes, message: object) -> None:

    def single(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        data = dict(pairs)
        if len(data) < len(pairs):
            message = f"the program wrote a field twice (--validate): {shown_line(line)}"
            raise Misbehaved("doubled-field", message)
        return data

    data = json.loads(line, object_pairs_hook=single)
    for place in ms.unknown_fields(data, message):
        description = f"{place}, which the schema does not list (--validate)"
        raise Misbehaved("unknown-field", f"the program wrote {description}: {shown_line(line)}")


def shown_line(line: bytes) -> str:
    """A line as printable text, cut to `SHOWN` characters."""
    return shown(line[: 2 * SHOWN].decode(errors="backslashreplace"), limit=SHOWN)


def crash_report(
    child: Child, due: str, advice: str = "", *, who: str = PROGRAM, when: str = ""
) -> Misbehaved:
    """Why a program's output ended too early.

    Args:
        due: what it was to do next, as in "delivered a map".
        advice: the end of the message if the program crashed.
        who: the subject of the sentence.
        when: how far it came, as in "after 3 moves".
    """
    status, crashed = child.exit_status(), child.signal() in CRASHES
    complaint = f"{last_words(child.stderr())}{advice if crashed else ''}"
    if child.in_half_a_line:
        end = status or "closed its output"
        message = f"{who} {end} in the middle of a line{complaint}"
        return Misbehaved("half-line", message, signal=child.signal())
    if status is None:
        return Misbehaved("closed-output", f"{who} closed its output and runs on")
    came = f" {when}," if when else ""
    message = f"{who} {status}{came} before it {due}{complaint}"
    return Misbehaved("crashed", message, signal=child.signal())


def silence_report(child: Child, message: str, *, over: bool = False) -> Misbehaved | None:
    """Why a program that ran out of time was silent, or None; `over`: it has ended the world."""
    if over:
        detail = " after it had ended the world, and does not read on"
        return Misbehaved("not-reading", message, detail=detail)
    if child.in_half_a_line:
        return Misbehaved("half-line", message, detail=f", in the middle of a line{seen(child)}")
    if child.input_closed:
        return Misbehaved("closed-input", message, detail="; it has closed its input")
    if child.flooded_stderr:
        detail = f"; it wrote more than {ms.LIMIT} bytes on standard error"
        return Misbehaved("flooded-stderr", message, detail=detail)
    return None


def last_words(stderr: str) -> str:
    """The last lines on standard error, or a sanitizer's summary, to append to a sentence."""
    lines = [shown(line.strip()) for line in stderr.splitlines() if line.strip()]
    lines = [line for line in lines if line.startswith("SUMMARY: ")] or lines[-LAST_LINES:]
    if not lines:
        return ""
    which = "last line" if len(lines) == 1 else "last lines"
    return f"; its {which} on standard error: {' / '.join(lines)}"


def seen(child: Child) -> str:
    """The first unexpected line, to append to a sentence."""
    return f": {shown_line(child.unread)}" if child.unread else ""
