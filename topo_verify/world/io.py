"""Which format a file has: its name says.

| name ends in | format |
| --- | --- |
| `.pc`, `.plc` | planar_code |
| `.graphml` | GraphML with positions |
| `.net.xml` | a road network of SUMO |
| anything else | world JSON |
"""

from __future__ import annotations

import os
from os import PathLike
from typing import TypeVar

from topo_verify.errors import InputError
from topo_verify.text import shown
from topo_verify.world.formats import graphml, planar_code, sumo, world_json
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def load(cls: type[W], path: str | PathLike[str], *, graph: int | None = None) -> W:
    """The world in the file.

    Args:
        graph: which of the graphs in a file of planar_code, counted from 0; default: the only one.
    Raises:
        InputError: the file cannot be read, or holds no world.
    """
    name = os.fspath(path).lower()
    if name.endswith((".pc", ".plc")):
        return planar_code.load(cls, path, graph=graph)
    if graph is not None:
        raise InputError(
            f"{shown(path)}: graph={graph} is for planar_code (.pc, .plc); the other formats"
            " hold one world a file"
        )
    if name.endswith(".graphml"):
        return graphml.load(cls, path)
    if name.endswith(".net.xml"):
        return sumo.load(cls, path)
    return world_json.load(cls, path)
