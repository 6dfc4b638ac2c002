"""SUMO's road networks, `.net.xml`: the undirected graph of their streets.

The reader takes each `<junction>` with `id`, `x`, `y` and each `<edge>` with `id`, `from`, `to` and
an optional `shape`; not those within a junction, whose id begins with ':'. Both directions of a
street are one edge, if their ids differ only in a leading '-' or their shapes are each other's
reverse.

Source: docs/formats.md; Eclipse SUMO, user documentation, "SUMO Road Networks".
"""

from __future__ import annotations

import re
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, geometry, markup
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def decode(cls: type[W], data: bytes, *, name: str = "SUMO network", stem: str = "") -> W:
    """The world in the bytes."""
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
            subject = f"{name}: {path[1]} '{shown(key, limit=60)}'"
            if not key or key in known:
                why = "stands there twice" if key else "has no id"
                raise InputError(f"{subject} {why}: each needs a distinct id")
            if key.startswith(":"):
                return
            if path[1] == "edge":
                edges[key] = attributes
                points += attributes.get("shape", "").count(",")
            else:
                x, y = (
                    geometry.number(attributes.get(axis, ""), f"{subject}, {axis}") for axis in "xy"
                )
                places[key] = DrawnVertex(key, (x, y))
            embedding.require_size(name, vertices=len(places), edges=len(edges), points=points)

    def end(_path: tuple[str, ...], _text: str) -> None:
        """SUMO's texts are attributes."""

    markup.read(data, name=name, start=start, end=end)
    ways = _ways(places, edges, name)
    return embedding.as_world(cls, list(places.values()), ways, Flaws(name), name=stem)


def _ways(
    places: dict[str, DrawnVertex], edges: dict[str, dict[str, str]], name: str
) -> list[DrawnEdge]:
    number = {key: place for place, key in enumerate(places)}
    ways: dict[str, DrawnEdge] = {}
    for key, attributes in edges.items():
        subject = f"{name}: edge '{shown(key, limit=60)}'"
        start, end = (number.get(attributes.get(side, "")) for side in ("from", "to"))
        if start is None or end is None:
            raise InputError(f"{subject}: expected the ids of two junctions as 'from' and 'to'")
        # lazily, as geometry.line
        shape = re.finditer(r"\S+", attributes.get("shape", ""))
        rows = (point[0].split(",") for point in shape)
        course = geometry.points(rows, f"{subject}, shape")
        other = ways.get(key[1:] if key.startswith("-") else f"-{key}")
        if other is None or (other.start, other.end) != (end, start):
            ways[key] = DrawnEdge(start, end, course, directed=True, name=key)
    return list(ways.values())
