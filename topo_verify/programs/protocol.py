"""Protocol 1 and the batch format: every message as a type, and its JSON Schema.

    to the program      start, percept, stop               {"id", "world"}           (batch)
    from the program    move, declare, done, skip, error   {"id", "doors", "map"}    (batch)

One JSON object a line. A field that is not known is passed over, so that either side may be the
newer one; a `type` that is not known is refused. The files in `schemas/` are made from these types
and a test keeps them equal.

    $ python -m topo_verify.programs.protocol     # the four schemas, as one JSON object

Source: docs/semantics.md, section 15; docs/oracle.md.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from inspect import cleandoc
from typing import Any, Literal, cast

import msgspec

from topo_verify.robot.events import Decision, MapData, Number
from topo_verify.robot.percept import Percept
from topo_verify.world.formats.world_json import WorldFile

PROTOCOL: Literal[1] = 1
"""The version of the protocol."""

LIMIT = 2**20
"""Bytes that a message may have, its line end not counted."""


class _Message(msgspec.Struct, frozen=True, tag_field="type", tag=str.lower):
    """Base of the messages of protocol 1: immutable, tagged with the class name in lower case."""


# ---------------------------------------------------------------- to the program


class Start(_Message, frozen=True, kw_only=True):
    """A world begins: the robot stands at the marker and senses this."""

    protocol: Literal[1] = PROTOCOL
    percept: Percept


class Sensed(_Message, frozen=True, gc=False, tag="percept"):
    """What is sensed behind the door of the last move."""

    degree: int
    marker: int | None


class Stop(_Message, frozen=True):
    """There are no more worlds: end."""


ToProgram = Start | Sensed | Stop


# ---------------------------------------------------------------- from the program


class Move(_Message, frozen=True, gc=False):
    """Leave by a door, 0 … degree-1; answered by a percept."""

    door: Number


class Declare(_Message, frozen=True):
    """Put a decision on record; not answered."""

    event: Decision


class Done(_Message, frozen=True):
    """The world is mapped; `cost` is the program's own count of its moves, if it keeps one."""

    map: MapData
    cost: Number | None = None


class Skip(_Message, frozen=True):
    """The program does not do this world, and why."""

    why: str = ""


class Error(_Message, frozen=True):
    """The program gives this world up, and why."""

    why: str = ""


FromProgram = Move | Declare | Done | Skip | Error


# ---------------------------------------------------------------- batch


class Task(msgspec.Struct, frozen=True):
    """A world to be mapped; `id` comes back with the run."""

    id: str
    world: WorldFile


class Declared(msgspec.Struct, frozen=True):
    """A decision, and after how many moves it was made."""

    after: Number
    event: Decision


class Run(msgspec.Struct, frozen=True, omit_defaults=True):
    """What the program did in a world: its doors, its decisions, its map.

    `skip` or `error`, a sentence, stand in place of `map` where it delivers none.
    """

    id: str
    doors: tuple[Number, ...] = ()
    declare: tuple[Declared, ...] = ()
    map: MapData | None = None
    cost: Number | None = None
    skip: str | None = None
    error: str | None = None


# ---------------------------------------------------------------- schemas

SCHEMAS: dict[str, Any] = {
    "to-program": ToProgram,
    "from-program": FromProgram,
    "batch-world": Task,
    "batch-run": Run,
}
"""The types of which a JSON Schema lies in the package, `schemas/<name>.schema.json`."""


def schema(name: str) -> dict[str, Any]:
    """The JSON Schema of one kind of line."""
    return dialect(msgspec.json.schema(SCHEMAS[name]))


def dialect(made: dict[str, Any]) -> dict[str, Any]:
    """The schema with its dialect named, the same under every Python.

    Descriptions are docstrings, and whether these keep their indentation depends on the Python.
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_unindented(made)}


def _unindented(part: Any) -> Any:
    if isinstance(part, list):
        return [_unindented(one) for one in cast("list[object]", part)]
    if isinstance(part, dict):
        items = cast("dict[str, object]", part).items()
        return {
            key: cleandoc(value)
            if key == "description" and isinstance(value, str)
            else _unindented(value)
            for key, value in items
        }
    return part


def strangers(data: Any, message: object, place: str = "$") -> Iterator[str]:
    """The fields of a message that no schema lists, by their places.

    Args:
        data: the message as plain JSON data.
        message: what it was decoded to.
    """
    if isinstance(message, msgspec.Struct):
        fields = dict(zip(message.__struct_encode_fields__, message.__struct_fields__, strict=True))
        for name in data:
            if name in fields:
                yield from strangers(data[name], getattr(message, fields[name]), f"{place}.{name}")
            elif name != message.__struct_config__.tag_field:
                yield f"{place}.{name}"
    elif isinstance(message, tuple):
        rows = cast("tuple[object, ...]", message)
        for number, (one, other) in enumerate(zip(data, rows, strict=True)):
            yield from strangers(one, other, f"{place}[{number}]")


if __name__ == "__main__":
    sys.stdout.write(json.dumps({name: schema(name) for name in SCHEMAS}, indent=2) + "\n")
