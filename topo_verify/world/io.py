"""Reads and writes worlds; the end of a file's name says its format.

| name ends in | format |
| --- | --- |
| `.pc`, `.plc` | planar_code |
| `.graphml` | GraphML |
| `.net.xml` | a road network of SUMO |
| `.nx.json` | NetworkX's node-link JSON |
| anything else | world JSON; written to `.json`, and to a name without an ending |

A file that begins with the head of planar_code is planar_code, whatever its name. A file may be
packed by gzip; behind each ending `.gz` may follow.
"""

# Formats are imported late: parsers load slowly.

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

PLANAR_CODE = b">>planar_code"
"""How a file of planar_code begins, unless its head is left out."""

_ENDINGS = {
    ".pc": "planar_code",
    ".plc": "planar_code",
    ".graphml": "graphml",
    ".net.xml": "sumo",
    ".nx.json": "nx-json",
}

WRITTEN = {"json": ".json", "planar_code": ".pc", "graphml": ".graphml", "nx-json": ".nx.json"}
"""The formats that are written, each with the end of its files' names."""


def format_of_name(path: str | PathLike[str]) -> str:
    """The format that the file's name stands for. InputError: it is a picture's."""
    name = files.unpacked_name(path).lower()
    if name.endswith((".svg", ".png", ".pdf")):
        raise InputError(
            f"{shown(path)}: expected a name for data, as w.json, got one for a picture; those are"
            " made by topo-verify world draw, and by certify --draw"
        )
    return next((kind for ending, kind in _ENDINGS.items() if name.endswith(ending)), "json")


def written_format(path: str | PathLike[str]) -> str:
    """The format by the name of a file to be written; InputError if none is written by that name.

    A name without an ending stands for world JSON.
    """
    kind, ending = format_of_name(path), Path(path).suffix.lower()
    if kind not in WRITTEN or (kind == "json" and ending not in {"", ".json"}):
        raise InputError(
            f"{shown(path)}: no format with this ending is written: expected a name that ends in"
            f" one of {', '.join(WRITTEN.values())}"
        )
    return kind


def load(
    cls: type[W],
    path: str | PathLike[str],
    *,
    graph: int | None = None,
    largest_part: bool = False,
) -> W:
    """The world in the file; `World.load` documents the arguments.

    Args:
        largest_part: keep only the largest part of a drawing, and remark what is left out.
    """
    from topo_verify.world.formats import other

    kind, name = format_of_name(path), shown(path)
    data = files.unpacked(files.read(path), name)
    if not data.startswith(PLANAR_CODE):
        other.refuse(path, data, kind)
    stem = files.stem(path).removesuffix({"sumo": ".net", "nx-json": ".nx"}.get(kind, ""))
    return decoded(cls, data, kind, name=name, stem=stem, graph=graph, largest_part=largest_part)


def decoded(
    cls: type[W],
    data: bytes,
    kind: str,
    *,
    name: str,
    stem: str = "",
    graph: int | None = None,
    largest_part: bool = False,
) -> W:
    """The world in the bytes, which are of this kind, or planar_code with its head."""
    from topo_verify.world.formats import graphml, node_link, planar_code, sumo, world_json

    if kind == "planar_code" or data.startswith(PLANAR_CODE):
        return planar_code.decode(cls, data, name=name, stem=stem, graph=graph)
    if graph is not None:
        raise InputError(
            f"{name}: graph={graph} is for planar_code (.pc, .plc); the other formats"
            " hold one world a file: leave it out"
        )
    match kind:
        case "graphml":
            return graphml.decode(cls, data, name=name, stem=stem, largest_part=largest_part)
        case "sumo":
            return sumo.decode(cls, data, name=name, stem=stem, largest_part=largest_part)
        case "nx-json":
            return node_link.decode(cls, data, name=name, stem=stem, largest_part=largest_part)
        case _:
            return world_json.decode(cls, data, name=name, stem=stem)


def decode(cls: type[W], text: str | bytes) -> W:
    """The world in this world JSON."""
    from topo_verify.world.formats import world_json

    return world_json.decode(cls, text)


def from_text(text: str) -> World:
    """The world with this `World.text`: an id, or world JSON."""
    return World.from_json(text) if text.startswith("{") else World.from_id(text)


def encode(world: World) -> str:
    """World JSON on one line."""
    from topo_verify.world.formats import world_json

    return world_json.encode(world)


def save(world: World, path: str | PathLike[str], kind: str | None = None) -> None:
    """Write the world to the file, whole or not at all, in this format, or that of its name.

    Raises:
        InputError: the file cannot be written, the world has no such format, or no format
            is written by this name.
    """
    content = encoded(world, kind or written_format(path))
    files.write(path, content + "\n" if isinstance(content, str) else content)


def encoded(world: World, kind: str) -> str | bytes:
    """The world in a format of `WRITTEN`."""
    from topo_verify.world.formats import graphml, node_link, planar_code, world_json

    match kind:
        case "planar_code":
            return planar_code.encode(world)
        case "graphml":
            return graphml.encode(world)
        case "nx-json":
            return node_link.encode(world)
        case _:
            return world_json.encode(world)
