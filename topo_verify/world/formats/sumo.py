"""SUMO's road networks, `.net.xml`: the undirected graph of their streets.

The reader takes each `<junction>` with its `id`, `x`, `y` (y upwards) and each `<edge>` with its
`id`, `from`, `to` and, if it has one, its `shape`, the line in the middle of the street (SUMO
leaves it out where it is straight). It ignores lanes, connections, traffic lights and the kinds of
traffic, and everything within a junction: elements whose id begins with ':'.

**Both directions of a street are one edge.** SUMO's edges have one direction. Two of them between
the same junctions, there and back, are one street if their ids differ in a leading '-' and nothing
else (so SUMO names them), or if one has the shape of the other backwards; the shape of the first in
the file counts. Others stay apart, as the carriageways of a motorway do.

embedding.py says how the drawing becomes a world, and what is refused: for example, junctions
without a street and networks in several parts. `netconvert --keep-edges.components 1` keeps the
largest part.

Source: Eclipse SUMO, user documentation, "SUMO Road Networks".
"""

from __future__ import annotations

import re
from os import PathLike
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, files, markup
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex, Point
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def load(cls: type[W], path: str | PathLike[str]) -> W:
    """The world in the file.

    Raises:
        InputError: as `decode`, or the file cannot be read.
    """
    stem = files.stem(path).removesuffix(".net")
    return decode(cls, files.read(path), name=shown(path), stem=stem)


def decode(cls: type[W], data: bytes, *, name: str = "SUMO network", stem: str = "") -> W:
    """The world in the bytes.

    Args:
        name: what to call the input in messages.
        stem: what to call the world.
    Raises:
        InputError: the bytes are not a SUMO network, or the drawing is refused.
    """
    places: dict[str, DrawnVertex] = {}
    edges: dict[str, dict[str, str]] = {}
    points = 0

    def start(path: tuple[str, ...], attributes: dict[str, str]) -> None:
        nonlocal points
        if path[0] != "net":
            raise InputError(
                f"{name}: expected a SUMO network, whose first element is <net>: name a file of"
                " that kind"
            )
        if path[1:] in {("junction",), ("edge",)}:
            known = places if path[1] == "junction" else edges
            key = attributes.get("id", "")
            what = f"{name}: {path[1]} '{shown(key, limit=60)}'"
            if not key or key in known:
                why = "stands there twice" if key else "has no id"
                raise InputError(f"{what} {why}: each has an id of its own")
            if key.startswith(":"):  # within a junction
                return
            if path[1] == "edge":
                edges[key] = attributes
                points += attributes.get("shape", "").count(",")  # each point has one at least
            else:
                places[key] = DrawnVertex(key, _at(attributes, what))
            embedding.require_size(name, vertices=len(places), edges=len(edges), points=points)

    def end(_path: tuple[str, ...], _text: str) -> None:
        """Does nothing: SUMO writes everything into attributes."""

    markup.read(data, name=name, start=start, end=end)
    ways = _ways(places, edges, name)
    return embedding.as_world(cls, list(places.values()), ways, source=name, name=stem)


def _at(attributes: dict[str, str], what: str) -> Point:
    x, y = (embedding.number(attributes.get(axis, ""), f"{what}, {axis}") for axis in "xy")
    return x, y


def _ways(
    places: dict[str, DrawnVertex], edges: dict[str, dict[str, str]], name: str
) -> list[DrawnEdge]:
    number = {key: place for place, key in enumerate(places)}
    ways: dict[str, DrawnEdge] = {}
    for key, attributes in edges.items():
        what = f"{name}: edge '{shown(key, limit=60)}'"
        start, end = (number.get(attributes.get(side, "")) for side in ("from", "to"))
        if start is None or end is None:
            raise InputError(f"{what}: expected the ids of two junctions as 'from' and 'to'")
        # One point at a time: see embedding.line.
        shape = re.finditer(r"\S+", attributes.get("shape", ""))
        rows = (point[0].split(",") for point in shape)
        course = embedding.points(rows, f"{what}, shape")
        # SUMO names the other direction of a street with a leading "-".
        other = ways.get(key[1:] if key.startswith("-") else f"-{key}")
        if other is None or (other.start, other.end) != (end, start):
            ways[key] = DrawnEdge(start, end, course, directed=True, name=key)
    return list(ways.values())
