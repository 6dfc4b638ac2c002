"""World JSON: one world in one JSON object.

    {"format": "topo-verify/world", "version": 1, "name": "triangle",
     "vertices": [[0, 5], [1, 2], [3, 4]], "edges": [[0, 1], [2, 3], [4, 5]], "marker": 0}

Unknown and repeated fields are refused, because results about a misread world are worthless. What
this does not show: that rotations were meant clockwise.

Source: docs/semantics.md, section 14.
"""

from __future__ import annotations

import json
import re
from typing import Annotated, Any, Final, Literal, TypeVar

import msgspec
from msgspec import UNSET, Meta, UnsetType

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World
from topo_verify.world.validation import Number

W = TypeVar("W", bound=World)

VERSION: Final = 1


class WorldFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A world file: an embedded graph with one directional marker."""

    # part of the schema; error messages end with the descriptions

    format: Annotated[
        Literal["topo-verify/world"], Meta(description="the name of this format, topo-verify/world")
    ]
    version: Annotated[Literal[1], Meta(description="the version of this format, 1")]
    name: Annotated[str, Meta(description="a text, what the world is called")] | UnsetType = UNSET
    vertices: Annotated[
        tuple[tuple[Number, ...], ...],
        Meta(description="one list a vertex, its darts (integers) in clockwise order"),
    ]
    edges: Annotated[
        tuple[tuple[Number, Number], ...],
        Meta(description="one list an edge, its two darts (integers)"),
    ]
    marker: Annotated[
        Number | None,
        Meta(description="the dart that the marker points at, null only where there is no dart"),
    ]
    vertex_names: (
        Annotated[tuple[str, ...], Meta(min_length=1, description="one text a vertex")] | UnsetType
    ) = UNSET
    positions: (
        Annotated[
            tuple[tuple[float, float], ...],
            Meta(min_length=1, description="one pair of numbers [x, y] a vertex, y upwards"),
        ]
        | UnsetType
    ) = UNSET
    source: Annotated[str, Meta(description="a text, where the world comes from")] | UnsetType = (
        UNSET
    )
    licence: (
        Annotated[str, Meta(description="a text, on what terms the world may be used")] | UnsetType
    ) = UNSET


class _Header(msgspec.Struct):
    format: str
    version: int


def schema() -> dict[str, Any]:
    """The JSON Schema of a world file, as in `world.schema.json`."""
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, **msgspec.json.schema(WorldFile)}


def decode(cls: type[W], text: str | bytes, *, name: str = "world JSON", stem: str = "") -> W:
    """The world in the text; a byte order mark is ignored."""
    data = _parse(text, name)
    try:
        return cls.from_rotations(
            data.vertices,
            data.edges,
            data.marker,
            name=data.name or stem,
            vertex_names=data.vertex_names or (),
            positions=data.positions or (),
            source=data.source or "",
            licence=data.licence or "",
        )
    except InputError as error:
        raise InputError(f"{name}: {error}") from error


def _parse(text: str | bytes, name: str) -> WorldFile:
    text = utf8_text(text, name)
    try:
        _require_version(msgspec.json.decode(text, type=_Header), name)
        data = msgspec.json.decode(text, type=WorldFile)
    except msgspec.ValidationError as error:
        sentence = _sentence(str(error), name)
        if '"nodes"' in text:
            sentence += "; a file of node-link JSON has a name that ends in .nx.json"
        raise InputError(sentence) from error
    except msgspec.DecodeError as error:
        why = _lower(str(error).removeprefix("JSON is malformed: "))
        is_log = '"start"' in text[:200] or "degree" in text[:200].lower()
        log = ""
        if is_log:
            log = " (a log is judged by certify LOG, and watched by replay LOG --world MAP)"
        raise InputError(
            f"{name} is not valid JSON: {why}; a world is one JSON object{log}"
        ) from error
    except RecursionError as error:
        raise InputError(
            f"{name}: expected a world, got lists that are nested too deeply: give one a vertex"
        ) from error
    # msgspec keeps the last of two equal keys
    require_single_keys(text, name)
    return data


def utf8_text(text: str | bytes, name: str) -> str:
    """The text without a byte order mark; refuses what is not UTF-8, empty or too large."""
    try:
        data = text.encode() if isinstance(text, str) else text
        text = data.decode()
    except UnicodeError as error:
        raise InputError(f"{name} is not UTF-8 text: {error}; save it as UTF-8") from error
    if len(data) > files.LIMIT:
        raise InputError(files.too_large(name))
    text = text.removeprefix("\ufeff")
    if not text.strip():
        raise InputError(f"{name} is empty: a world is one JSON object; name a file that holds one")
    return text


def _require_version(header: _Header, name: str) -> None:
    if header.format != "topo-verify/world":
        raise InputError(
            f"{name}: expected the 'format' 'topo-verify/world', got '{shown(header.format)}':"
            " name the file of a world"
        )
    if header.version > VERSION:
        raise InputError(
            f"{name} has version {header.version} of the world format, and this topo-verify reads"
            f" versions up to {VERSION}: update it"
        )


def require_single_keys(text: str, name: str) -> None:
    """Refuse JSON in which an object has a field twice."""

    def single(pairs: list[tuple[str, Any]]) -> None:
        keys: set[str] = set()
        for key, _ in pairs:
            if key in keys:
                raise InputError(f"{name} has the field '{key}' twice: leave one of the two out")
            keys.add(key)

    # long integers cannot be parsed
    json.loads(text, object_pairs_hook=single, parse_int=str)


def _sentence(error: str, name: str) -> str:
    problem, _, place = error.partition(" - at `$.")
    fields = schema()["$defs"]["WorldFile"]["properties"]
    named = re.match(r"\w+", place) or re.search(r"(?<=missing required field `)\w+", problem)
    if named and named[0] in fields:
        expected = f"'{named[0]}' is {fields[named[0]]['description']}"
    else:
        expected = f"a world is one JSON object with no fields but {', '.join(fields)}"
    where = f"{name}, {shown(place[:-1])}" if place else name
    mends = {"missing": "add it", "unknown": "leave it out"}
    mend = next((text for word, text in mends.items() if f" {word} " in problem), "correct it")
    return f"{where}: {shown(_lower(problem))}; {mend}: {expected}"


def _lower(sentence: str) -> str:
    return sentence[:1].lower() + sentence[1:]


def to_data(world: World) -> WorldFile:
    """The world as a struct, also for other formats."""
    return WorldFile(
        format="topo-verify/world",
        version=VERSION,
        name=world.name,
        vertices=world.vertices,
        edges=world.edges,
        marker=world.root,
        vertex_names=world.vertex_names or UNSET,
        positions=world.positions or UNSET,
        source=world.source or UNSET,
        licence=world.licence or UNSET,
    )


def encode(world: World) -> str:
    """World JSON on one line."""
    return encoded(to_data(world))


def encoded(data: msgspec.Struct) -> str:
    """The struct as JSON on one line; refuses half of a surrogate pair."""
    try:
        return msgspec.json.encode(data).decode()
    except UnicodeEncodeError as error:
        raise InputError(
            f"expected Unicode in the world's name and texts: {error}; replace that character"
        ) from error
