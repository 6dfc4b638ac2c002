"""Reads worlds from files and text, and writes them; the end of a file's name says its format.

| name ends in | format |
| --- | --- |
| `.pc`, `.plc` | planar_code |
| `.graphml` | GraphML with positions |
| `.net.xml` | a road network of SUMO |
| anything else | world JSON |

Text without a file name, and whatever `World.save` writes, is world JSON. The other formats are
written by the commands that ask for them.
"""

# Each format is imported in the function that uses it. Parsers of XML and JSON take longer to load
# than the rest of this package, and most programs that import `World` never open a file.

from __future__ import annotations

import os
from os import PathLike
from typing import TypeVar

from topo_verify.errors import InputError
from topo_verify.text import shown
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def load(cls: type[W], path: str | PathLike[str], *, graph: int | None = None) -> W:
    """The world in the file.

    Args:
        graph: which of the graphs in a file of planar_code, counted from 0; default: the only one.
    Raises:
        InputError: the file cannot be read, or holds no world.
    """
    from topo_verify.world.formats import graphml, planar_code, sumo, world_json

    name = os.fspath(path).lower()
    if name.endswith((".pc", ".plc")):
        return planar_code.load(cls, path, graph=graph)
    if graph is not None:
        raise InputError(
            f"{shown(path)}: graph={graph} is for planar_code (.pc, .plc); the other formats"
            " hold one world a file: leave it out"
        )
    if name.endswith(".graphml"):
        return graphml.load(cls, path)
    if name.endswith(".net.xml"):
        return sumo.load(cls, path)
    return world_json.load(cls, path)


def decode(cls: type[W], text: str | bytes) -> W:
    """The world in this world JSON.

    Raises:
        InputError: the text holds no world.
    """
    from topo_verify.world.formats import world_json

    return world_json.decode(cls, text)


def encode(world: World) -> str:
    """World JSON on one line: the same bytes for the same world."""
    from topo_verify.world.formats import world_json

    return world_json.encode(world)


def save(world: World, path: str | PathLike[str]) -> None:
    """Write world JSON to the file: all of it or, if anything fails, nothing.

    Raises:
        InputError: the file cannot be written.
    """
    from topo_verify.world.formats import world_json

    world_json.save(world, path)
