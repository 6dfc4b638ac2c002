"""Protocol 1 and the batch format: every message as a type, and its JSON Schema.

    to the program      start, percept, stop               {"id", "world"}           (batch)
    from the program    move, declare, done, skip, error   {"id", "doors", "map"}    (batch)

Each line is one JSON object. The decoder ignores unknown fields, so that either side may be newer,
and refuses an unknown `type`. The files in `schemas/` are generated:

    $ python -m topo_verify.programs.protocol     # the four schemas, as one JSON object

Source: docs/semantics.md, section 15; docs/reference/programs.md.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from inspect import cleandoc
from typing import Any, Literal, cast

import msgspec

from topo_verify.programs.loaded import Loaded
from topo_verify.robot.events import Decision, MapData
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.world.formats.world_json import WorldFile
from topo_verify.world.validation import Number

PROTOCOL: Literal[1] = 1
"""The version of the protocol."""

LIMIT = 2**20
"""The most bytes of a message, without its line end."""


def _tag(class_name: str) -> str:
    return class_name.removesuffix("Message").lower()


class _Message(msgspec.Struct, frozen=True, tag_field="type", tag=_tag):
    pass


# ---------------------------------------------------------------- to the program


class StartMessage(_Message, frozen=True, kw_only=True):
    """A world begins: `percept` is what the robot senses at the marker."""

    protocol: Literal[1] = PROTOCOL
    percept: Percept


# gc=False for speed: these messages cannot be part of a circle of references.
class PerceptMessage(_Message, frozen=True, gc=False):
    """What the robot senses after the last move."""

    degree: int
    marker: int | None


class StopMessage(_Message, frozen=True):
    """There are no more worlds: the program ends."""


ToProgram = StartMessage | PerceptMessage | StopMessage


# ---------------------------------------------------------------- from the program


class MoveMessage(_Message, frozen=True, gc=False, omit_defaults=True):
    """The robot leaves by a door, 0 … degree-1. The harness answers with a percept.

    `purpose` says what the move is for; it is recorded, and never needed.
    """

    # A door that does not exist is the robot's finding, not a malformed line.
    door: Door
    purpose: Purpose | None = None


class DeclareMessage(_Message, frozen=True):
    """The program declares a decision. The harness does not answer."""

    event: Decision


class DoneMessage(_Message, frozen=True):
    """The program delivers its map; `cost` is its own count of moves, if it keeps one."""

    map: MapData
    cost: Number | None = None


class SkipMessage(_Message, frozen=True):
    """The program declines this world, and says why."""

    why: str = ""


class ErrorMessage(_Message, frozen=True):
    """The program gives this world up, and says why."""

    why: str = ""


FromProgram = MoveMessage | DeclareMessage | DoneMessage | SkipMessage | ErrorMessage


# ---------------------------------------------------------------- our own child

# Other programs never receive these messages, and may not send them. The allowed answers depend on
# the question.


class ReadyMessage(_Message, frozen=True):
    """From our child: the mapper is loaded."""


class RefusedMessage(_Message, frozen=True):
    """From our child: the TARGET names no mapper, or what it has loaded cannot be listed."""

    why: str


class UndeliveredMessage(_Message, frozen=True):
    """From our child: the mapper raised, returned no map, misused the robot or skips the world."""

    kind: Literal["no-map", "out-of-memory", "bad-door", "bad-declaration", "skip"]
    why: str


class OverMessage(_Message, frozen=True):
    """To our child, in place of a percept: end the world, for the robot was stopped."""


class StockMessage(_Message, frozen=True):
    """To our child, between two worlds: say what the mapper has loaded."""


class LoadedMessage(_Message, frozen=True):
    """From our child: what the mapper has loaded."""

    loaded: Loaded


ToChild = ToProgram | OverMessage | StockMessage
FromLoading = ReadyMessage | RefusedMessage
"""From our child while it loads the mapper."""
FromStock = LoadedMessage | RefusedMessage
"""From our child in answer to `stock`."""
FromChild = MoveMessage | DeclareMessage | DoneMessage | UndeliveredMessage
"""From our child in a world."""


# ---------------------------------------------------------------- batch


class BatchTask(msgspec.Struct, frozen=True):
    """A world for the program to map; its run repeats the `id`."""

    id: str
    world: WorldFile


class BatchDecision(msgspec.Struct, frozen=True):
    """A decision, and the number of moves before it."""

    after: Number
    event: Decision


class BatchRun(msgspec.Struct, frozen=True, omit_defaults=True):
    """A program's run in one world: its doors, its decisions, its map.

    A program that delivers no map sends `skip` or `error`, a sentence, instead.
    """

    id: str
    doors: tuple[Door, ...] = ()
    declare: tuple[BatchDecision, ...] = ()
    map: MapData | None = None
    cost: Number | None = None
    skip: str | None = None
    error: str | None = None


# ---------------------------------------------------------------- schemas

SCHEMAS: dict[str, Any] = {
    "to-program": ToProgram,
    "from-program": FromProgram,
    "batch-world": BatchTask,
    "batch-run": BatchRun,
}
"""The types of lines; the package holds `schemas/<name>.schema.json` for each."""


def schema(name: str) -> dict[str, Any]:
    """The JSON Schema of the named kind of line."""
    return dialect(msgspec.json.schema(SCHEMAS[name]))


def dialect(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with its dialect named and unindented descriptions, as in Python 3.13."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_unindented(schema)}


def _unindented(part: Any) -> Any:
    if isinstance(part, list):
        return [_unindented(item) for item in cast("list[object]", part)]
    if isinstance(part, dict):
        items = cast("dict[str, object]", part).items()
        return {
            key: cleandoc(value)
            if key == "description" and isinstance(value, str)
            else _unindented(value)
            for key, value in items
        }
    return part


def unknown_fields(data: Any, message: object, place: str = "$") -> Iterator[str]:
    """Yield the fields of a message that its schema does not list, each as a path from `$`."""
    if isinstance(message, msgspec.Struct):
        fields = dict(zip(message.__struct_encode_fields__, message.__struct_fields__, strict=True))
        for name in data:
            if name in fields:
                yield from unknown_fields(
                    data[name], getattr(message, fields[name]), f"{place}.{name}"
                )
            elif name != message.__struct_config__.tag_field:
                yield f"{place}.{name}"
    elif isinstance(message, tuple):
        rows = cast("tuple[object, ...]", message)
        for number, (item, field) in enumerate(zip(data, rows, strict=True)):
            yield from unknown_fields(item, field, f"{place}[{number}]")


if __name__ == "__main__":
    sys.stdout.write(json.dumps({name: schema(name) for name in SCHEMAS}, indent=2) + "\n")
